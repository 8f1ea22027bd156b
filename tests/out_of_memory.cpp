// Memory that runs out: whichever allocation of a call fails, the call says so as an Error, and
// what it was made on draws the next frame as if nothing had been.
#include <gtest/gtest.h>

#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <burnish/renderer.hpp>
#include <burnish/shapes.hpp>
#include <burnish/trace.hpp>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/failing_new.hpp"
#include "tests/scenes.hpp"
#include "tests/scratch_directory.hpp"

namespace burnish {
namespace {

using failing_new::allocations_left;

/// call() with the n-th of its allocations failing for n = 0, 1, .. until there is none that fails;
/// from `in_a_row` on it leaves some out. After each, recovered().
void fail_one_by_one(const std::function<void()>& call, const std::function<void()>& recovered,
                     std::int64_t in_a_row = 40) {
    int failures = 0;
    for (std::int64_t n = 0;; n += 1 + n / in_a_row) {
        allocations_left = n;
        try {
            call();
            const bool had_enough = allocations_left.exchange(-1) >= 0;
            if (had_enough) break;
        } catch (const Error& error) {
            allocations_left = -1;
            EXPECT_EQ(error.code(), ErrorCode::limit) << "allocation " << n << ": " << error.what();
            ++failures;
        } catch (const std::exception& error) {
            allocations_left = -1;
            FAIL() << "allocation " << n << ": " << error.what() << ", expected Error{limit}";
        }
        recovered();
        if (testing::Test::HasFailure()) FAIL() << "after allocation " << n;
    }
    EXPECT_GT(failures, 0);
}

std::vector<std::byte> bytes_of(const Framebuffer& frame) {
    std::vector<std::byte> bytes;
    for (int y = 0; y < frame.height(); ++y)
        bytes.insert(bytes.end(), frame.row(y),
                     frame.row(y) + static_cast<std::size_t>(frame.width()) * 4);
    return bytes;
}

/// Directions and widths from maps, with mip levels of their moments.
Scene ward_with_levels() {
    Scene scene = scenes::knot();
    Material material = *scene.objects[0].material;
    material.model = Model::ward_duer;
    material.mipmaps = MaterialMipmaps{.method = MipMethod::moments};
    scene.objects[0].material = std::make_shared<const Material>(material);
    return scene;
}

const std::size_t kNoCap = RendererOptions{}.memory_cap;

struct Case {
    const char* name;
    Scene (*scene)();
    const char* machine = nullptr;  ///< another one than the scene's
    std::size_t memory_cap = kNoCap;
    std::int64_t in_a_row = 40;  ///< of fail_one_by_one: fewer where each takes long
};
void PrintTo(const Case& c, std::ostream* out) {
    *out << c.name;
}

class OutOfMemory : public testing::TestWithParam<Case> {
  protected:
    static Scene scene() {
        Scene scene = GetParam().scene();
        if (GetParam().machine != nullptr) scene.machine = machine_profile(GetParam().machine);
        return scene;
    }
    static Renderer renderer() {
        return Renderer({.threads = 2, .memory_cap = GetParam().memory_cap});
    }
};

TEST(OutOfMemoryRenderers, AreErrors) {
    for (const bool accounting : {false, true}) {
        const RendererOptions options{.threads = 4, .accounting = accounting};
        fail_one_by_one([&] { const Renderer renderer(options); }, [] {});
    }
}

/// Of a renderer's first frame, which compiles and derives everything.
TEST_P(OutOfMemory, OfAFrameIsAnErrorAndTheNextFrameIsWhole) {
    const Scene scene = this->scene();
    Framebuffer frame(80, 60);
    renderer().render(scene, frame);
    const std::vector<std::byte> want = bytes_of(frame);
    std::optional<Renderer> drawing;
    drawing.emplace(renderer());
    fail_one_by_one([&] { drawing->render(scene, frame); },
                    [&] {
                        std::memset(frame.row(0), 0x55, 4);
                        drawing->render(scene, frame);
                        EXPECT_EQ(bytes_of(frame), want);
                        drawing.emplace(renderer());
                    },
                    GetParam().in_a_row);
}

/// Programs and registers are not for double precision.
class OutOfMachineMemory : public OutOfMemory {};

TEST_P(OutOfMachineMemory, OfAProgramIsAnError) {
    const Scene scene = this->scene();
    std::optional<Renderer> drawing;
    const auto anew = [&] { drawing.emplace(renderer()); };
    anew();
    fail_one_by_one([&] { drawing->check(scene, 0); }, anew, GetParam().in_a_row);
    anew();
    fail_one_by_one([&] { drawing->program(scene, 0); }, anew, GetParam().in_a_row);
}

TEST_P(OutOfMachineMemory, OfATraceIsAnError) {
    Scene scene = this->scene();
    scene.width = 80;
    scene.height = 60;
    fail_one_by_one([&] { trace_pixel(scene, 40, 30); }, [] {}, GetParam().in_a_row);
}

std::string name_of(const testing::TestParamInfo<Case>& its) {
    return its.param.name;
}
INSTANTIATE_TEST_SUITE_P(
    Scenes, OutOfMachineMemory,
    testing::Values(Case{"knot", scenes::knot}, Case{"machine", scenes::machine},
                    Case{"filtered_after", scenes::filtered_after},
                    Case{"ward_with_levels", ward_with_levels, nullptr, kNoCap, 4}),
    name_of);
INSTANTIATE_TEST_SUITE_P(
    Scenes, OutOfMemory,
    testing::Values(Case{"knot", scenes::knot}, Case{"machine", scenes::machine},
                    Case{"near_plane", scenes::near_plane}, Case{"layers", scenes::layers},
                    Case{"two_lights", scenes::two_lights},
                    Case{"filtered_after", scenes::filtered_after},
                    Case{"flushed", scenes::knot, nullptr, 1},
                    Case{"ward_with_levels", ward_with_levels, nullptr, kNoCap, 4},
                    Case{"double", ward_with_levels, "double"}),
    name_of);

class OutOfMemoryFiles : public ScratchDirectory {};

/// Scene files and images are beyond us: toml++ and OpenImageIO end the process.
TEST_F(OutOfMemoryFiles, MeshesThatAreReadAreErrors) {
    const auto file = std::filesystem::path(BURNISH_SOURCE_DIR) / "meshes" / "cube.obj";
    load_mesh(file);  // libraries that are loaded with it do not survive a failure
    fail_one_by_one([&] { load_mesh(file); }, [] {});
}

TEST_F(OutOfMemoryFiles, MeshesThatAreWrittenAppearWholeOrNotAtAll) {
    const std::filesystem::path file = path("mesh.obj");
    const MeshData cube = shapes::cube();
    save_text("before", file);
    fail_one_by_one([&] { save_mesh(cube, file); },
                    [&] {
                        EXPECT_EQ(read(file), "before");
                        EXPECT_EQ(entries(), std::vector<std::string>{"mesh.obj"});
                    });
    EXPECT_EQ(load_mesh(file).report.triangles, 12U);
}

}  // namespace
}  // namespace burnish
