// draw_gallery MESHES DIRECTORY DOCUMENT: contact sheets as PNG to DIRECTORY, and what machines say
// to models that they cannot draw into the section "machines" of DOCUMENT. MESHES has the scene
// files. `./run gallery`.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <burnish/materials.hpp>
#include <burnish/renderer.hpp>
#include <burnish/shapes.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>

#include "lab/document_section.hpp"
#include "lab/measure_model.hpp"
#include "lab/sheet.hpp"

namespace burnish::lab {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 4> kMachines{"geforce256", "nv2a", "ideal", "double"};
constexpr std::array<std::string_view, 2> kIdealAndDouble{"ideal", "double"};
constexpr int kCell = 160;

/// Model by model, one row of machines: constant parameters, the light such that the double
/// picture's peak is 0.9. Returns the table of refusals.
std::string draw_models(const fs::path& directory) {
    std::string table = "| model | geforce256 | nv2a |\n|---|---|---|\n";
    const ModelParameters parameters = constant_parameters(0.15F, 0.5F, 16.0F);
    Renderer renderer;
    for (std::size_t model = 0; model < model_names().size(); ++model) {
        Sheet sheet(static_cast<int>(kMachines.size()), 1, kCell, kCell);
        Material material = parameters.material;
        material.model = Model(model);
        Scene scene = measured_scene(material, "double");
        expose(scene);
        scene.background = {0.10F, 0.11F, 0.13F, 1.0F};
        table += fmt::format("| `{}` |", model_names()[model]);
        for (std::size_t i = 0; i < kMachines.size(); ++i) {
            scene.machine = measured_scene(material, kMachines[i]).machine;
            std::string verdict = "drawn";
            try {
                Framebuffer frame(2 * kCell, 2 * kCell);
                renderer.render(scene, frame);
                sheet.place(static_cast<int>(i), 0, frame);
            } catch (const Error& error) {
                verdict = error.what();
            }
            if (i < 2) table += fmt::format(" {} |", verdict);
        }
        table += "\n";
        save_image(sheet.image(), directory / fmt::format("model_{}.png", model_names()[model]));
    }
    return table;
}

/// A scene file on ideal and, below it, in double precision.
void draw_file(const fs::path& file, const fs::path& directory) {
    Scene scene = load_scene(file).scene;
    Sheet sheet(1, 2, scene.width / 2, scene.height / 2);
    Renderer renderer;
    for (std::size_t i = 0; i < kIdealAndDouble.size(); ++i) {
        scene.machine = machine_profile(kIdealAndDouble[i]);
        Framebuffer frame(scene.width, scene.height);
        renderer.render(scene, frame);
        sheet.place(0, static_cast<int>(i), frame);
    }
    save_image(sheet.image(), directory / fmt::format("scene_{}.png", file.stem().string()));
}

/// u runs the other way, tangents with it: mirrored frames.
MeshData mirrored(MeshData data) {
    for (glm::vec2& uv : data.uvs) uv.x = 1.0F - uv.x;
    for (glm::vec4& tangent : data.tangents) tangent = -tangent;
    return data;
}

/// Tangents and stripes of the shapes, and of a sphere with mirrored uvs.
void draw_frames(const fs::path& directory) {
    const std::array<MeshData, 5> shapes{
        shapes::named("sphere", 96, 48), mirrored(shapes::named("sphere", 96, 48)),
        shapes::named("knot", 400, 48), shapes::named("plane", 1, 1), shapes::named("cube", 1, 1)};
    Sheet sheet(static_cast<int>(shapes.size()), 2, kCell, kCell);
    Renderer renderer;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        Scene scene;
        const Mesh mesh(shapes[i]);
        scene.camera = framing_camera(mesh.bounds(), 1.0F);
        scene.objects.push_back({mesh, nullptr, glm::mat4(1.0F), {}});
        Framebuffer frame(2 * kCell, 2 * kCell);
        renderer.render(scene, frame, Aov::tangent);
        sheet.place(static_cast<int>(i), 0, frame);
        renderer.render(scene, frame, Aov::stripes);
        sheet.place(static_cast<int>(i), 1, frame);
    }
    save_image(sheet.image(), directory / "tangent_frames.png");
}

}  // namespace
}  // namespace burnish::lab

int main(int argc, char** argv) {
    if (argc != 4) {
        fmt::print(stderr, "usage: draw_gallery MESHES DIRECTORY DOCUMENT\n");
        return 2;
    }
    try {
        namespace lab = burnish::lab;
        const std::filesystem::path meshes = argv[1], directory = argv[2];
        std::filesystem::create_directories(directory);
        lab::replace_section(argv[3], "machines", lab::draw_models(directory));
        for (const char* file :
             {"ward.toml", "fibres.toml", "generated.toml", "generated_spheres.toml"})
            lab::draw_file(meshes / file, directory);
        lab::draw_frames(directory);
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "draw_gallery: {}\n", error.what());
        return 3;
    }
}
