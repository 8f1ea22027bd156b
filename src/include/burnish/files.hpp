#pragma once

#include <burnish/experiment.hpp>
#include <burnish/framebuffer.hpp>
#include <burnish/mesh.hpp>
#include <burnish/scene.hpp>
#include <burnish/texture.hpp>
#include <burnish/view_state.hpp>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

/// Files in and out. The code behind these calls (OpenImageIO, OpenMesh, TOML) lives in the library
/// burnish_io, which is loaded at the first call: programs that touch no file start in
/// milliseconds.
///
/// Common to all: Error{io} if a file cannot be opened, read or written, Error{bad_input} if its
/// bytes make no sense (the message begins with FILE:LINE where lines exist), Error{limit} if it is
/// too large. A file that is written appears whole or not at all. Safe from several threads.
namespace burnish {

/// What reading a mesh had to decide or leave out.
struct MeshReport {
    std::size_t polygons = 0;            ///< in the file
    std::size_t triangles = 0;           ///< drawn
    std::size_t boundary_edges = 0;      ///< edges with a face on one side only
    std::size_t nonmanifold_faces = 0;   ///< refused by the half-edge structure, drawn all the same
    std::size_t degenerate_faces = 0;    ///< zero area or fewer than 3 distinct corners: skipped
    std::size_t nonfinite_vertices = 0;  ///< faces that use them are skipped
    std::size_t nonfinite_faces = 0;     ///< skipped for that reason
    bool generated_normals = false;
    bool generated_uvs = false;

    /// The lines that a user should be told, without a file name; empty if all is well.
    [[nodiscard]] std::vector<std::string> notes() const;
};

struct LoadedMesh {
    Mesh mesh;
    MeshReport report;
};

/// OBJ, PLY (ASCII, binary little and big endian), OFF, STL (ASCII, binary), by content where the
/// format has a magic word, else by extension.
LoadedMesh load_mesh(const std::filesystem::path& path);

/// Any image OpenImageIO reads, as RGBA8: grey is spread over r, g, b; a missing alpha is 255.
/// Values are not colour-converted and alpha is not multiplied in.
Image8 load_image(const std::filesystem::path& path);

/// The same as an rgba32f frame: floats of the file as they are, integers over their largest (a
/// byte n is n / 255, a word n / 65535), a missing alpha 1.
Framebuffer load_frame(const std::filesystem::path& path);

/// PNG, EXR, or whatever OpenImageIO writes, by extension; "-" writes PNG to standard output.
/// 8- and 16-bit frames go to 8- and 16-bit files where the format has them.
void save_image(const Framebuffer& frame, const std::filesystem::path& path);
void save_image(const Image8& image, const std::filesystem::path& path);

/// The same with a text in the file, where the format has a place for one: "Description" of PNG.
void save_image(const Framebuffer& frame, const std::filesystem::path& path,
                std::string_view description);

/// Writes a line of UTF-8 into an rgba32f frame, letters of DejaVu Sans (Debian package
/// fonts-dejavu-core) `size` pixels high, the base line beginning at pixel (x, y); what lies
/// outside the frame is cut off. Throws Error{io} where the font is missing.
void draw_text(Framebuffer& frame, int x, int y, std::string_view text, int size,
               const glm::vec4& color);

/// Text as it is; "-" is no special name.
void save_text(std::string_view text, const std::filesystem::path& path);

/// Writes binary little-endian PLY or OBJ, by extension, with normals and uvs.
void save_mesh(const MeshData& mesh, const std::filesystem::path& path);

struct LoadedScene {
    Scene scene;
    std::vector<std::string> notes;  ///< lines for the user, each beginning with a file name
};

/// A scene file (TOML, `schema = 1`). Unknown keys are errors that name the nearest known key.
/// `overrides` are "key.path=value" pairs applied before the file is interpreted.
LoadedScene load_scene(const std::filesystem::path& path,
                       const std::vector<std::string>& overrides = {});

/// A material file (TOML, `schema = 1`): one [material] and the [[textures]] that it names.
Material load_material(const std::filesystem::path& path);

/// An experiment (TOML, `schema = 1`; docs/experiments.md). Scenes are relative to the file and
/// must be there. Unknown keys, axes and values are errors that name the nearest known one.
Experiment load_experiment(const std::filesystem::path& path);

/// The file and, if it is TOML, the files that it names, and those that these name: what a change
/// of a picture may come from. Throws Error for TOML that cannot be parsed.
std::vector<std::filesystem::path> input_files(const std::filesystem::path& path);

/// A state that `burnish view` saved: TOML, or a PNG file with that text as its description.
/// Names of files in it are relative to its directory.
ViewState load_view_state(const std::filesystem::path& path);

/// A bare mesh file as a scene: framed camera, one light, brushed steel, profile `ideal`.
LoadedScene scene_for_mesh(const std::filesystem::path& path);

}  // namespace burnish
