#pragma once

#include <burnish/machine.hpp>
#include <burnish/renderer.hpp>
#include <burnish/scene.hpp>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "metrics/metrics.hpp"

/// What the user asked for, as plain data. What a verb accepts stands in app/options;
/// only command_line.cpp knows the parser.
namespace burnish::app {

struct CameraOptions {
    std::optional<glm::vec3> position, focal_point, view_up;
    std::optional<float> view_angle;
    float azimuth = 0.0F;    ///< degrees about view_up, after the above
    float elevation = 0.0F;  ///< degrees towards view_up
    float zoom = 1.0F;       ///< divides the view angle
};

/// Common to render, trace and bench: what is drawn, and how.
struct PictureOptions {
    std::filesystem::path input;
    std::vector<std::string> overrides;  ///< -D
    std::optional<glm::ivec2> size;
    std::optional<std::string> machine;
    std::filesystem::path material;  ///< instead of the meshes' own, if not empty
    std::optional<Model> model;      ///< instead of the materials' own
    /// Instead of the materials' own.
    std::optional<MaterialMipmaps> mipmaps;
    std::optional<int> max_anisotropy;  ///< of the materials with mip levels of their parameters
    bool multipass = false;
    std::optional<std::string> half_vector;  ///< of choose_half_vector
    std::optional<FilterOrder> filter_order;
    CameraOptions camera;
    std::vector<Light> lights;  ///< instead of the scene's, if not empty
    std::optional<glm::vec4> background;
    int threads = 0;
    std::string isa;
    bool quiet = false;
    bool verbose = false;
};

enum class StatsFormat { none, text, json };

/// What the picture shows instead of colours.
using Shown = std::variant<ShownRegister, Aov>;

struct Threshold {
    metrics::Metric metric;
    double limit;
};

/// Both are drawn; from 0.
struct FrameRange {
    int first, last;
};

struct RenderOptions {
    PictureOptions picture;
    std::string output;                ///< empty: the input's stem + ".png"; "-": standard output
    int samples_side = 1;              ///< samples per pixel: its square
    int turntable = 0;                 ///< frames of one turn; 0: a single picture
    std::optional<FrameRange> frames;  ///< of the turntable; all of them
    std::string reference;             ///< what the pictures are compared with; empty: nothing
    std::vector<Threshold> limits;     ///< of that comparison; empty: the same picture
    StatsFormat stats = StatsFormat::none;
    std::optional<Shown> shown;  ///< --aov
};

struct ViewOptions {
    PictureOptions picture;            ///< its input is empty with `load_state`
    std::filesystem::path load_state;  ///< a state or a screenshot; empty: none
    std::filesystem::path save_state;  ///< when the window closes; empty: nowhere
};

struct TraceOptions {
    PictureOptions picture;
    std::optional<glm::ivec2> pixel;  ///< not negative; there is one unless by_stage
    int samples_side = 1;             ///< samples per pixel: its square; 1 with by_stage
    bool by_stage = false;            ///< where the error comes from, instead of registers
    std::string bits;                 ///< of lab::set_stage_bits, after the machine's own
    std::string rounding;             ///< likewise; empty: the machine's
    std::filesystem::path output;     ///< a waterfall as SVG; empty: none
    bool json = false;
};

struct BenchOptions {
    PictureOptions picture;
    int frames = 50;
    int samples_side = 1;        ///< samples per pixel: its square
    std::optional<Shown> shown;  ///< --aov
    bool balance = false;        ///< instead of times
    bool json = false;
};

struct CompareOptions {
    std::filesystem::path test, reference;
    metrics::CompareOptions measured;
    std::vector<Threshold> thresholds;
    std::filesystem::path difference, absolute_difference, heat_map;  ///< empty: none
    double gain = 1.0;                                                ///< of differences as bytes
    int threads = 0;
    bool json = false;
    bool quiet = false;
};

struct CompileOptions {
    std::filesystem::path combiners;
    std::filesystem::path texture_shader;  ///< empty: none
    bool json = false;
};

/// A reflectance model instead of a program. Not both `model` and `material` are missing.
struct CompileModelOptions {
    std::optional<Model> model;      ///< instead of the material's own
    std::filesystem::path material;  ///< empty: the default material
    std::string machine = "ideal";
    bool json = false;
};

struct InfoOptions {
    bool json = false;
};

struct BakeBrushedOptions {
    std::uint32_t seed = 1;
    int size = 512;
    std::filesystem::path output;  ///< a directory, or what the four names begin with
};

struct BakeMaterialOptions {
    std::string set;  ///< one of generated_set_names()
    std::uint32_t seed = 1;
    int size = 512;
    std::filesystem::path output;  ///< a directory, made if need be
};

/// A material file or a generated set.
struct BakeMipsOptions {
    std::filesystem::path material;  ///< empty: the set
    std::string set;                 ///< one of generated_set_names()
    std::uint32_t seed = 1;
    int size = 512;
    MaterialMipmaps mipmaps{MipMethod::moments};
    std::filesystem::path output;  ///< a directory, made if need be
};

/// One of three sources: what glTF says, as numbers or textures; two widths; a material file.
struct BakeAnisotropyOptions {
    std::optional<double> roughness, strength, rotation;  ///< glTF's factors; radians
    std::filesystem::path texture;                        ///< anisotropyTexture
    std::filesystem::path roughness_texture;              ///< metallicRoughnessTexture
    std::optional<double> alpha_x, alpha_y, direction;    ///< degrees
    std::filesystem::path material;
    std::filesystem::path output;  ///< a directory, made if need be; of textures and materials
    bool json = false;             ///< of numbers
};

struct BakeMeshOptions {
    std::string shape;
    int columns = 64;  ///< of the grid; segments along the knot
    int rows = 32;     ///< of the grid; sides of the knot
    std::filesystem::path output;
};

/// An experiment, or the directories of its shards to be joined.
struct ExperimentOptions {
    std::string experiment;  ///< a name or a file; empty: join `shards`
    std::vector<std::filesystem::path> merged;
    std::filesystem::path output;  ///< a directory, made if need be
    bool quick = false;
    int shard = 1, shards = 1;
    int threads = 0;
    bool quiet = false;
};

/// Text that was asked for instead of work: --help or --version.
struct PrintText {
    std::string text;
};

using Command = std::variant<PrintText, RenderOptions, ViewOptions, TraceOptions, BenchOptions,
                             CompareOptions, CompileOptions, CompileModelOptions, InfoOptions,
                             BakeBrushedOptions, BakeMaterialOptions, BakeMipsOptions,
                             BakeAnisotropyOptions, BakeMeshOptions, ExperimentOptions>;

/// Throws Error{bad_option} for anything that is not a command of burnish.
Command parse_command_line(int argc, const char* const* argv);

}  // namespace burnish::app
