// What the interpolators hand to the machine, against double precision: colours within 0.51 of a
// unit of the machine's input format (0.5 of which is its rounding), texture coordinates within
// 1/256 texel. The reference evaluates barycentric weights directly; the renderer evaluates plane
// equations in float.
#include <gtest/gtest.h>

#include <array>
#include <burnish/combiner.hpp>
#include <burnish/renderer.hpp>
#include <burnish/shapes.hpp>
#include <cmath>

#include "core/cpu.hpp"
#include "draw.hpp"
#include "raster/bin.hpp"
#include "raster/tile.hpp"
#include "shade/attributes.hpp"

namespace burnish {
namespace {

using Vector = std::array<double, 3>;

Vector operator*(const Vector& v, double s) {
    return {v[0] * s, v[1] * s, v[2] * s};
}
Vector operator+(const Vector& a, const Vector& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector unit(const Vector& v) {
    return v * (1.0 / std::sqrt(dot(v, v)));
}
double cross(double ax, double ay, double bx, double by) {
    return ax * by - ay * bx;
}

/// Weights of the three corners at the centre of pixel (px, py); they sum to 1.
Vector corner_weights(const ScreenMesh& mesh, const SetupTriangle& t, int px, int py) {
    const double x = px + 0.5, y = py + 0.5;
    const std::array<std::uint32_t, 3> vertex = corner_vertices(mesh, t);
    Vector result{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        const HomogeneousVertex &hj = mesh.homogeneous[vertex[j]],
                                &hk = mesh.homogeneous[vertex[k]];
        if (t.clipped == 0) {
            // Area opposite to corner i in the window, over its w.
            result[i] = cross(t.x[j] / 256.0 - x, t.y[j] / 256.0 - y, t.x[k] / 256.0 - x,
                              t.y[k] / 256.0 - y) /
                        static_cast<double>(mesh.homogeneous[vertex[i]].w);
        } else {
            // Same, times all three w: no corner needs to be in front of the eye.
            const double wj = static_cast<double>(hj.w), wk = static_cast<double>(hk.w);
            result[i] =
                cross(static_cast<double>(hj.x) - x * wj, static_cast<double>(hj.y) - y * wj,
                      static_cast<double>(hk.x) - x * wk, static_cast<double>(hk.y) - y * wk);
        }
    }
    return result * (1.0 / (result[0] + result[1] + result[2]));
}

double blend(const Vector& weights, float a, float b, float c) {
    return dot(weights, {static_cast<double>(a), static_cast<double>(b), static_cast<double>(c)});
}

/// Mesh, camera and a program that reads the half vector and n.l.
struct AttributeScene {
    Scene scene;
    std::string name;
    double texels = 512.0;  ///< side of the texture that uv address
};

ProgramMaterial half_vector_program() {
    using namespace combine;
    ProgramBuilder p;
    p.lerp(raw(Register::zero), raw(Register::zero), raw(Register::zero), raw(Register::col0));
    p.out_alpha(alpha(raw(Register::col0)));
    ProgramMaterial material;
    material.combiners = p.build();
    material.col0_rgb = ColorInput::half_tangent;
    material.col0_a = ColorInput::n_dot_l;
    return material;
}

AttributeScene attribute_scene(const std::string& name, const Machine& machine) {
    AttributeScene s;
    s.name = name;
    s.scene.width = 480;
    s.scene.height = 270;
    s.scene.machine = machine;
    s.scene.lights.push_back({.position = {0.3F, 0.8F, 0.5F}});
    auto material = std::make_shared<Material>();
    material->program = half_vector_program();
    MeshData data;
    glm::mat4 place(1.0F);
    if (name == "ellipsoid") {
        data = shapes::sphere(144, 72, {1.65F, 1.10F, 1.10F});
    } else {  // a floor to the horizon, under and behind the camera
        data = shapes::plane(name == "floor" ? 24 : 2, name == "floor" ? 24 : 2);
        place = placement({0.0F, -0.5F, 0.0F}, {1.0F, 0.0F, 0.0F}, -90.0F, 80.0F);
        s.scene.camera.position = {0.0F, 0.4F, 1.0F};
        s.scene.camera.focal_point = {0.5F, 0.1F, -3.0F};
    }
    for (glm::vec2& uv : data.uvs) uv *= 4.0F;
    s.scene.objects.push_back({Mesh(data), material, place, {}});
    return s;
}

/// Largest errors over the visible pixels of a scene.
struct Errors {
    double texel = 0.0;  ///< of u or v, in texels
    double code = 0.0;   ///< of a colour, in units of the input format
    std::uint64_t pixels = 0;
};

class Measure {
  public:
    Measure(const AttributeScene& s, const KernelTable& kernels)
        : m_scene(s),
          m_kernels(kernels),
          m_pool(1),
          m_planes(16 * kPacketSize),
          m_attributes(static_cast<std::size_t>(kMaxAttributes) * kAttributeStride) {
        const Scene& scene = s.scene;
        m_frame = {&scene, make_view(scene.camera, scene.width, scene.height),
                   make_viewport(scene.machine, scene.width, scene.height)};
        DerivedMaps maps;
        prepare_draw(m_draw, m_frame, scene.objects[0], maps);
        transform_draw(m_draw, m_frame, scene.objects[0], kernels, m_pool);
        m_one = scene.machine.numbers == NumberModel::nine_bit ? 255.0 : 16384.0;
    }

    Errors run() {
        const FrameSize size{m_scene.scene.width, m_scene.scene.height};
        Chunk chunk;
        chunk.fill({m_draw.mesh(), 0, Facing::any, m_frame.viewport, size}, 0,
                   m_draw.triangle_count(), m_kernels);
        const DepthRule rule{1, 0, 0, 1};
        TileVisibility tile;
        for (std::int32_t y = 0; y * kTileSize < size.height; ++y) {
            for (std::int32_t x = 0; x * kTileSize < size.width; ++x) {
                tile.begin(x, y, size, nullptr);
                tile.draw(chunk, {&rule, 1}, m_kernels);
                measure_tile(tile);
            }
        }
        return m_errors;
    }

  private:
    void measure_tile(TileVisibility& tile) {
        const TileFragments found = tile.collect(m_kernels);
        const std::uint16_t* pixels = found.pixels;
        for (std::size_t i = 0; i < found.triangles.size(); ++i) {
            for (int left = found.size(i); left > 0;) {
                const int count = std::min(left, kPacketSize);
                measure_run(tile, *found.triangles[i], pixels, count);
                pixels += count;
                left -= count;
            }
        }
    }

    void measure_run(const TileVisibility& tile, const SetupTriangle& triangle,
                     const std::uint16_t* pixels, int count) {
        const SetupTriangle* const only[1] = {&triangle};
        m_equations.resize(equation_rows(m_draw.shading) * kAttributeStride);
        attribute_planes(m_draw.shading, m_draw.mesh(), only, m_kernels, m_plane_inputs,
                         m_equations.data());
        std::array<std::uint16_t, kPacketSize> padded{};
        std::copy_n(pixels, count, padded.begin());
        Packet packet{count,   padded.data(), m_attributes.data(), m_planes.data(), nullptr,
                      nullptr, nullptr};
        const Run run{0, count, tile.left() - triangle.reference_x,
                      tile.top() - triangle.reference_y};
        m_kernels.attributes(packet, {&run, 1, m_draw.shading.interpolated(), m_equations.data()});
        std::vector<int> color_planes;
        for (const InputOp& op : m_draw.shading.inputs) {
            if (const auto* lighting = std::get_if<LightingCtx>(&op))
                m_kernels.lighting(packet, *lighting);
            if (const auto* encode = std::get_if<EncodeCtx>(&op)) {
                (m_one == 255.0 ? m_kernels.encode_nine_bit : m_kernels.encode_wide)(packet,
                                                                                     *encode);
                color_planes.push_back(encode->plane);
            }
        }
        ASSERT_EQ(color_planes.size(), 4U);
        for (int i = 0; i < count; ++i) {
            const int index = padded[static_cast<std::size_t>(i)];
            const int px = tile.left() + ((index & 7) | (index >> 3 & 56));
            const int py = tile.top() + ((index >> 3 & 7) | (index >> 6 & 56));
            compare(triangle, px, py, i, color_planes);
        }
        m_errors.pixels += static_cast<std::uint64_t>(count);
    }

    void compare(const SetupTriangle& t, int px, int py, int fragment,
                 const std::vector<int>& planes) {
        const Vector weights = corner_weights(m_draw.mesh(), t, px, py);
        const Shading& s = m_draw.shading;
        const std::array<std::uint32_t, 3> vertex = corner_vertices(m_draw.mesh(), t);
        const VertexFrame &a = s.frames[vertex[0]], &b = s.frames[vertex[1]],
                          &c = s.frames[vertex[2]];
        const double u = blend(weights, a.uv.x, b.uv.x, c.uv.x);
        const double v = 1.0 - blend(weights, a.uv.y, b.uv.y, c.uv.y);
        for (const auto& [plane, want] : {std::pair{0, u}, std::pair{1, v}}) {
            const float got =
                m_attributes[static_cast<std::size_t>(plane * kAttributeStride + fragment)];
            const double error = std::abs(static_cast<double>(got) - want) * m_scene.texels;
            m_errors.texel = std::max(m_errors.texel, error);
        }
        const std::array<double, 4> colors = s.frame_attributes > kUvAttributes
                                                 ? lit_pixel(weights, {&a, &b, &c})
                                                 : lit_corners(weights, t);
        for (std::size_t k = 0; k < 4; ++k) {
            const double want = std::clamp(colors[k], 0.0, 1.0) * m_one;
            const int code = m_planes[static_cast<std::size_t>(planes[k] * kPacketSize + fragment)];
            m_errors.code = std::max(m_errors.code, std::abs(code - want));
        }
    }

    /// The half vector and n.l of the corners, interpolated.
    std::array<double, 4> lit_corners(const Vector& weights, const SetupTriangle& t) const {
        std::array<double, 4> result{};
        const Shading& s = m_draw.shading;
        const std::array<std::uint32_t, 3> vertex = corner_vertices(m_draw.mesh(), t);
        for (std::size_t k = 0; k < 4; ++k) {
            const auto value = [&](int i) {
                return s.rows.row(vertex[static_cast<std::size_t>(i)])[kUvAttributes + k];
            };
            result[k] = blend(weights, value(0), value(1), value(2));
        }
        return result;
    }

    /// The tangent frame interpolated, then light: as `ideal` does it.
    std::array<double, 4> lit_pixel(const Vector& weights,
                                    const std::array<const VertexFrame*, 3>& f) const {
        const auto mix = [&](auto&& get) {
            Vector sum{};
            for (std::size_t i = 0; i < 3; ++i) {
                const glm::vec3 v = get(*f[i]);
                sum = sum + Vector{static_cast<double>(v.x), static_cast<double>(v.y),
                                   static_cast<double>(v.z)} *
                                weights[i];
            }
            return sum;
        };
        const Vector t = mix([](const VertexFrame& v) { return glm::vec3(v.tangent); });
        const Vector b = mix([](const VertexFrame& v) {
            return glm::cross(v.normal, glm::vec3(v.tangent)) * v.tangent.w;
        });
        const Vector n = mix([](const VertexFrame& v) { return v.normal; });
        const Vector p = mix([](const VertexFrame& v) { return v.position; });
        const LightSpace& space = m_draw.shading.lights[0].space;
        const Vector light{static_cast<double>(space.light.x), static_cast<double>(space.light.y),
                           static_cast<double>(space.light.z)};
        const Vector eye{static_cast<double>(space.eye.x), static_cast<double>(space.eye.y),
                         static_cast<double>(space.eye.z)};
        const Vector l = unit(light), h = unit(l + unit(eye + p * -1.0));
        return {dot(t, h) * 0.5 + 0.5, dot(b, h) * 0.5 + 0.5, dot(n, h) * 0.5 + 0.5, dot(n, l)};
    }

    const AttributeScene& m_scene;
    const KernelTable& m_kernels;
    WorkerPool m_pool;
    FrameView m_frame{};
    Draw m_draw;
    double m_one = 255.0;
    AlignedVector<std::int16_t> m_planes;
    PlaneInputs m_plane_inputs;
    AlignedVector<float> m_equations;
    AlignedVector<float> m_attributes;
    Errors m_errors;
};

Errors measure(const std::string& name, const Machine& machine) {
    const AttributeScene scene = attribute_scene(name, machine);
    const Errors errors = Measure(scene, *available_tables().front()).run();
    testing::Test::RecordProperty("texel_error", std::to_string(errors.texel));
    testing::Test::RecordProperty("code_error", std::to_string(errors.code));
    std::printf("%-10s %-10s %8llu pixels: uv %.6f texel, colours %.4f units\n", name.c_str(),
                machine.name.c_str(), static_cast<unsigned long long>(errors.pixels), errors.texel,
                errors.code);
    return errors;
}

class Attributes : public testing::TestWithParam<const char*> {};

TEST_P(Attributes, NineBitColoursAndCoordinates) {
    const Errors errors = measure(GetParam(), machine_profile("geforce256"));
    EXPECT_GT(errors.pixels, 40000U);
    EXPECT_LE(errors.texel, 1.0 / 256.0);
    EXPECT_LE(errors.code, 0.51);
}

TEST_P(Attributes, WideColoursOfVertices) {
    Machine machine = machine_profile("ideal");
    machine.half_vector = HalfVector::vertex;
    const Errors errors = measure(GetParam(), machine);
    EXPECT_LE(errors.texel, 1.0 / 256.0);
    EXPECT_LE(errors.code, 0.51);
}

TEST_P(Attributes, WideColoursOfPixels) {
    const Errors errors = measure(GetParam(), machine_profile("ideal"));
    EXPECT_LE(errors.texel, 1.0 / 256.0);
    EXPECT_LE(errors.code, 0.51);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Attributes, testing::Values("ellipsoid", "floor", "two_triangles"),
                         [](const testing::TestParamInfo<const char*>& test) {
                             return std::string(test.param);
                         });

/// What a mesh's triangles interpolate for a program that passes a register on.
int interpolated(Register passed_on) {
    using namespace combine;
    ProgramBuilder p;
    p.lerp(raw(Register::zero), raw(Register::zero), raw(Register::zero), raw(passed_on));
    p.out_alpha(alpha(one()));
    ProgramMaterial material;
    material.combiners = p.build();
    material.units = {std::make_shared<const Texture>(Image8(1, 1), Sampler{})};
    Shading shading;
    plan_shading(shading, {&material, 1}, machine_profile("geforce256"), true);
    return shading.interpolated();
}

TEST(Planning, TrianglesInterpolateNothingForAProgramThatReadsNothing) {
    EXPECT_EQ(interpolated(Register::const0), 0);
    EXPECT_EQ(interpolated(tex(0)), kUvAttributes);
}

}  // namespace
}  // namespace burnish
