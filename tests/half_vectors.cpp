// Half vectors per vertex, per pixel and through cube maps, normalised or not, for a viewer here or
// far away.
#include <gtest/gtest.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/trace.hpp>
#include <cmath>
#include <cstdio>
#include <vector>

#include "shade/normalisation_cube.hpp"
#include "tests/scenes.hpp"

namespace burnish {
namespace {

/// The half vector as the picture.
std::shared_ptr<Material> half_vector_material(int units = 0) {
    using namespace combine;
    ProgramBuilder p;
    const Input zero = raw(Register::zero);
    p.lerp(zero, zero, zero, raw(Register::col0));
    p.out_alpha(alpha(one()));
    auto material = std::make_shared<Material>();
    material->program.emplace();
    material->program->combiners = p.build();
    material->program->col0_rgb = ColorInput::half_tangent;
    material->program->units.resize(static_cast<std::size_t>(units));
    return material;
}

Scene scene_of(const Machine& machine, const MeshData& mesh) {
    Scene scene = scenes::lit_scene(machine, 48, 36);
    scene.format = PixelFormat::rgba32f;
    scene.background = glm::vec4(0.0F);
    scene.objects.push_back({Mesh(mesh), half_vector_material(), glm::mat4(1.0F), {}});
    return scene;
}

std::vector<float> picture(const Scene& scene, const std::string& isa = {}, int threads = 1) {
    Framebuffer frame(scene.width, scene.height, scene.format);
    Renderer({.threads = threads, .isa = isa}).render(scene, frame);
    std::vector<float> pixels;
    for (int y = 0; y < frame.height(); ++y) {
        const auto* row = reinterpret_cast<const float*>(frame.row(y));
        pixels.insert(pixels.end(), row, row + std::ptrdiff_t{4} * frame.width());
    }
    return pixels;
}

Machine machine_with(const char* half_vector, int bits = 8, const char* profile = "ideal") {
    Machine machine = machine_profile(profile);
    choose_half_vector(machine, half_vector);
    machine.half_vector_bits = bits;
    return machine;
}

glm::dvec3 decoded(const std::vector<float>& pixels, std::size_t pixel) {
    return glm::dvec3(pixels[4 * pixel], pixels[4 * pixel + 1], pixels[4 * pixel + 2]) * 2.0 - 1.0;
}

// Light 60 degrees from the normal, a viewer far away on it: h stands at 30 degrees everywhere,
// (1/2, 0, sqrt(3)/2); not normalised (l + v) / 2 = (sqrt(3)/4, 0, 3/4).
TEST(HalfVectors, OfAnInfiniteViewerAreTheSameEverywhere) {
    for (const char* half : {"vertex", "pixel", "cube:256"}) {
        for (const bool normalise : {true, false}) {
            Machine machine = machine_with(half, half[0] == 'c' ? 16 : 8);
            if (half[0] == 'c' && !normalise) continue;
            machine.viewer = Viewer::infinite;
            machine.normalise_half_vector = normalise;
            Scene scene = scene_of(machine, shapes::plane(2, 2));
            scene.lights[0].position = {std::sqrt(3.0F), 0.0F, 1.0F};
            const std::vector<float> pixels = picture(scene);
            const glm::dvec3 want = normalise ? glm::dvec3(0.5, 0.0, std::sqrt(0.75))
                                              : glm::dvec3(std::sqrt(3.0) / 4.0, 0.0, 0.75);
            int covered = 0;
            for (std::size_t i = 0; i < pixels.size() / 4; ++i) {
                if (pixels[4 * i + 3] == 0.0F) continue;
                ++covered;
                const glm::dvec3 h = decoded(pixels, i);
                for (int c = 0; c < 3; ++c) ASSERT_NEAR(h[c], want[c], 2.5 / 16384.0) << half;
            }
            EXPECT_GT(covered, 150);
        }
    }
    Scene local = scene_of(machine_with("pixel"), shapes::plane(2, 2));
    const std::vector<float> pixels = picture(local);
    EXPECT_GT(std::abs(pixels[4 * (18 * 48 + 18)] - pixels[4 * (18 * 48 + 29)]), 0.02F);
}

// With the camera turned the direction is still the one back from what it looks at.
TEST(HalfVectors, InfiniteViewersLookAlongTheCamera) {
    Machine machine = machine_with("pixel");
    machine.viewer = Viewer::infinite;
    Scene scene = scene_of(machine, shapes::plane(2, 2));
    scene.camera.position = {3.0F, 1.0F, 4.0F};
    scene.camera.focal_point = {0.0F, 1.0F, 0.0F};
    scene.lights[0].position = {0.6F, 0.0F, 0.8F};  // where the camera is
    const std::vector<float> pixels = picture(scene);
    int covered = 0;
    for (std::size_t i = 0; i < pixels.size() / 4; ++i) {
        if (pixels[4 * i + 3] == 0.0F) continue;
        ++covered;
        const glm::dvec3 h = decoded(pixels, i);
        ASSERT_NEAR(h.x, 0.6, 2.0 / 16384.0);
        ASSERT_NEAR(h.y, 0.0, 2.0 / 16384.0);
        ASSERT_NEAR(h.z, 0.8, 2.0 / 16384.0);
    }
    EXPECT_GT(covered, 50);
}

/// Largest distances of the picture from the normalised sum that the trace says is exact: of
/// directions that meet a face between texels, and beside its outermost ones.
struct WorstErrors {
    double inside = 0.0, beside = 0.0;
};

bool is_inside(const glm::dvec3& h, int size) {
    double a[3] = {std::abs(h.x), std::abs(h.y), std::abs(h.z)};
    std::sort(std::begin(a), std::end(a));
    return a[1] / a[2] < 1.0 - 1.0 / size;
}

WorstErrors worst_errors(const Machine& machine) {
    const Scene scene = scene_of(machine, shapes::sphere(9, 6));
    const std::vector<float> pixels = picture(scene);
    WorstErrors worst;
    for (int y = 0; y < scene.height; ++y) {
        for (int x = 0; x < scene.width; ++x) {
            const PixelTrace trace = trace_pixel(scene, x, y);
            const auto pixel = static_cast<std::size_t>(y * scene.width + x);
            for (std::size_t c = 0; c < 4; ++c)
                EXPECT_EQ(trace.stored[c], static_cast<double>(pixels[4 * pixel + c]));
            if (!trace.fragment) continue;
            const auto& list = trace.fragment->interpolants;
            const auto sum = std::find_if(list.begin(), list.end(), [](const TracedInterpolant& i) {
                return i.name == "half_sum";
            });
            if (sum == list.end()) return {1.0, 1.0};
            const glm::dvec3 h(sum->numbers[0].exact, sum->numbers[1].exact, sum->numbers[2].exact);
            EXPECT_LT(glm::length(h), 1.0);
            const glm::dvec3 error = decoded(pixels, pixel) - glm::normalize(h);
            double& at = is_inside(h, machine.half_vector_size) ? worst.inside : worst.beside;
            for (int c = 0; c < 3; ++c) at = std::max(at, std::abs(error[c]));
        }
    }
    return worst;
}

// Between texels 2/N apart a chord lies (2/N)^2 / 8 below the sphere, of both axes 1/N^2; filter
// weights of 8 bits are up to 1/256 of 2/N off. Codes of 8 bits are 2/255 apart in x and stand for
// up to one step more than x (128 is 0 and reads as 1/255); of 9 bits 1/510 off; the register adds
// 1/16384 in x. Beside the outermost texels, 1/N from the edge of a face, nothing is blended: the
// direction turns by 1/N / sqrt(2) at most.
TEST(HalfVectors, ThroughACubeMapAreAsGoodAsItsTexels) {
    const auto bound = [](int n, double code) {
        return 1.0 / (n * n) + 2.0 / n / 256.0 + code + 1.5 / 16384.0;
    };
    const auto check = [&](const Machine& machine, double code) {
        const int n = machine.half_vector_size;
        const WorstErrors worst = worst_errors(machine);
        std::printf("cube:%d of %d bits: %.6f of at most %.6f, beside the outermost %.6f\n", n,
                    machine.half_vector_bits, worst.inside, bound(n, code), worst.beside);
        EXPECT_LE(worst.inside, bound(n, code));
        EXPECT_LE(worst.beside, bound(n, code) + 1.0 / n / std::sqrt(2.0));
        return worst.inside;
    };
    EXPECT_GT(check(machine_with("cube:4", 16), 0.0), check(machine_with("cube:16", 16), 0.0));
    const double sixteen = check(machine_with("cube:64", 16), 0.0);
    const double nine = check(machine_with("cube:64", 9), 1.0 / 510.0);
    const double eight = check(machine_with("cube:64"), 2.0 / 255.0);
    EXPECT_LT(sixteen, nine);
    EXPECT_LT(nine, eight);
    check(machine_with("cube:64", 8, "nv2a"), 4.0 / 255.0);
}

// One texel a side holds the middle of its face: nothing but axes comes out, of nearest faces.
TEST(HalfVectors, ThroughACubeMapOfOneTexel) {
    const std::vector<float> pixels =
        picture(scene_of(machine_with("cube:1", 16), shapes::sphere(24, 13)));
    for (std::size_t i = 0; i < pixels.size() / 4; ++i) {
        if (pixels[4 * i + 3] == 0.0F) continue;
        const glm::dvec3 h = decoded(pixels, i);
        ASSERT_NEAR(std::abs(h.x) + std::abs(h.y) + std::abs(h.z), 1.0, 6.0 / 16384.0);
        ASSERT_NEAR(std::max({std::abs(h.x), std::abs(h.y), std::abs(h.z)}), 1.0, 3.0 / 16384.0);
    }
}

// Texels point away from the middle of the cube, as far as their codes can say.
TEST(HalfVectors, TexelsOfTheCubeMapAreUnitVectors) {
    for (const int bits : {8, 9, 16}) {
        const TexturePtr cube = normalisation_cube(5, bits);
        const double one = bits == 8 ? 255.0 : 65535.0;
        const double step = bits == 8 ? 2.0 / 255.0 : bits == 9 ? 1.0 / 255.0 : 2.0 / 65535.0;
        for (int face = 0; face < 6; ++face) {
            for (int y = 0; y < 5; ++y) {
                for (int x = 0; x < 5; ++x) {
                    glm::dvec3 n;
                    for (int c = 0; c < 3; ++c)
                        n[c] = cube->texel(0, face, x, y, c) / one * 2.0 - 1.0;
                    EXPECT_NEAR(glm::length(n), 1.0, 1.8 * step);
                }
            }
            glm::dvec3 middle;
            for (int c = 0; c < 3; ++c) middle[c] = cube->texel(0, face, 2, 2, c) / one * 2.0 - 1.0;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(middle[c], c == face / 2 ? (face % 2 == 0 ? 1.0 : -1.0) : 0.0, step);
        }
    }
}

// A colour of nine bits gets a texel's byte as it is: half_scale and coordinates see the same.
TEST(HalfVectors, AreTheSameOnEveryInstructionSetAndThreadCount) {
    std::vector<Machine> machines{machine_with("cube:8", 8, "nv2a"),
                                  machine_with("cube:8", 9),
                                  machine_with("cube:8", 16),
                                  machine_with("vertex"),
                                  machine_with("pixel"),
                                  machine_with("pixel")};
    machines[3].normalise_half_vector = machines[4].normalise_half_vector = false;
    machines[4].viewer = machines[1].viewer = Viewer::infinite;
    machines[5].tangent_frames = TangentFrames::orthonormal;
    for (const Machine& machine : machines) {
        Scene scene = scene_of(machine, shapes::torus_knot(60, 9));
        scene.objects[0].material = [] {
            auto scaled = half_vector_material();
            scaled->program->half_scale = {1.5F, 2.0F, 0.75F};
            return scaled;
        }();
        scene.lights.push_back({.position = {1.0F, 0.4F, 1.0F}, .position_w = 1.0F});
        const std::vector<float> want = picture(scene, "reference");
        for (const IsaInfo& isa : instruction_sets()) {
            if (!isa.available) continue;
            for (const int threads : {1, 2, 3})
                EXPECT_EQ(picture(scene, std::string(isa.name), threads), want) << isa.name;
        }
    }
}

std::string complaint(const Machine& machine, int units) {
    Scene scene = scene_of(machine, shapes::plane(2, 2));
    scene.objects[0].material =
        units < 0 ? std::make_shared<Material>() : half_vector_material(units);
    try {
        picture(scene);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(HalfVectors, ACubeMapTakesATextureUnit) {
    EXPECT_EQ(complaint(machine_with("cube:8", 8, "nv2a"), 3), "");
    EXPECT_EQ(complaint(machine_with("cube:8", 8, "nv2a"), 4),
              "4 texture units, machine 'nv2a' has 3 besides the one that normalises half vectors");
    EXPECT_EQ(complaint(machine_with("cube:8", 8, "nv2a"), -1), "");
    EXPECT_NE(complaint(machine_with("cube:8", 8, "geforce256"), -1).find("texture units"),
              std::string::npos);
}

TEST(HalfVectors, WhatAMachineCannotDoIsSaid) {
    const auto refused = [](Machine machine) {
        try {
            machine.validate();
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(refused(machine_with("cube:8", 12)), "half_vector_bits = 12, expected 8, 9 or 16");
    EXPECT_EQ(refused(machine_with("pixel", 16)),
              "half_vector_bits = 16 without half_vector = cube:N");
    EXPECT_EQ(refused(machine_with("cube:8", 16, "nv2a")),
              "half_vector_bits = 16 with numbers = nine_bit, expected 8: a colour has no more "
              "there");
    Machine raw = machine_with("cube:8");
    raw.normalise_half_vector = false;
    EXPECT_NE(refused(raw).find("whose map normalises"), std::string::npos);
    Machine derivative = machine_with("vertex");
    derivative.tangent_frames = TangentFrames::derivative;
    EXPECT_NE(refused(derivative).find("expected half_vector = pixel"), std::string::npos);
    for (const char* word : {"", "cube", "cube:", "cube:0", "cube:1025", "cube:8x", "cub:8",
                             "Pixel", "cube:-1", "cube:99999999999"}) {
        Machine machine;
        EXPECT_THROW(choose_half_vector(machine, word), Error) << word;
    }
}

}  // namespace
}  // namespace burnish
