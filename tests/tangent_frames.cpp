// Tangent frames at the pixel: interpolated, orthonormal, from the triangles' own uv derivatives;
// mirrored uv; and the strokes that show them.
#include <gtest/gtest.h>

#include <algorithm>
#include <burnish/trace.hpp>
#include <cmath>
#include <cstring>

#include "tests/scenes.hpp"

namespace burnish {
namespace {

constexpr TangentFrames kModes[] = {TangentFrames::mikktspace, TangentFrames::orthonormal,
                                    TangentFrames::derivative};

Scene scene_of(const MeshData& mesh, TangentFrames frames, int size = 64) {
    Scene scene = scenes::lit_scene(machine_profile("ideal"), size, size);
    scene.machine.tangent_frames = frames;
    scene.objects.push_back(
        {Mesh(mesh), std::make_shared<Material>(), glm::mat4(1.0F), {.cull = Cull::back}});
    return scene;
}

/// A picture of floats.
class Picture {
  public:
    Picture(const Scene& scene, Aov aov, const std::string& isa = {}, int threads = 1)
        : m_frame(scene.width, scene.height, PixelFormat::rgba32f) {
        Renderer({.threads = threads, .isa = isa}).render(scene, m_frame, aov);
    }
    [[nodiscard]] glm::dvec3 at(int x, int y) const { return glm::dvec3(pixel(x, y)); }
    [[nodiscard]] bool covers(int x, int y) const { return pixel(x, y).a > 0.0F; }
    [[nodiscard]] glm::vec4 pixel(int x, int y) const {
        glm::vec4 p;
        std::memcpy(&p, m_frame.row(y) + static_cast<std::size_t>(x) * sizeof p, sizeof p);
        return p;
    }
    [[nodiscard]] int width() const { return m_frame.width(); }
    [[nodiscard]] int height() const { return m_frame.height(); }
    friend bool operator==(const Picture& a, const Picture& b) {
        for (int y = 0; y < a.height(); ++y) {
            const auto bytes = static_cast<std::size_t>(a.width()) * sizeof(glm::vec4);
            if (std::memcmp(a.m_frame.row(y), b.m_frame.row(y), bytes) != 0) return false;
        }
        return true;
    }

  private:
    Framebuffer m_frame;
};

struct Frames {
    explicit Frames(const Scene& scene)
        : t(scene, Aov::tangent), b(scene, Aov::bitangent), n(scene, Aov::normal) {}
    Picture t, b, n;
};

/// Largest cosine between two axes of the frames of a picture.
double skew(const Frames& f) {
    double worst = 0.0;
    for (int y = 0; y < f.t.height(); ++y) {
        for (int x = 0; x < f.t.width(); ++x) {
            if (!f.t.covers(x, y)) continue;
            const glm::dvec3 t = f.t.at(x, y), b = f.b.at(x, y), n = f.n.at(x, y);
            for (const glm::dvec3& axis : {t, b, n}) EXPECT_NEAR(glm::length(axis), 1.0, 1e-6);
            worst = std::max({worst, std::abs(glm::dot(t, b)), std::abs(glm::dot(t, n)),
                              std::abs(glm::dot(b, n))});
        }
    }
    return worst;
}

/// A mesh with u running the other way: tangents as its files would get them.
MeshData mirrored(MeshData mesh) {
    for (glm::vec2& uv : mesh.uvs) uv.x = -uv.x;
    for (glm::vec4& t : mesh.tangents) t = -t;
    return mesh;
}

TEST(TangentFrames, OfAPlaneAreItsAxes) {
    for (const TangentFrames mode : kModes) {
        const Frames plain(scene_of(shapes::plane(3, 3), mode));
        const Frames turned(scene_of(mirrored(shapes::plane(3, 3)), mode));
        const int x = 32, y = 30;
        EXPECT_EQ(plain.t.at(x, y), glm::dvec3(1, 0, 0));
        EXPECT_EQ(plain.b.at(x, y), glm::dvec3(0, 1, 0));
        EXPECT_EQ(turned.t.at(x, y), glm::dvec3(-1, 0, 0));
        EXPECT_EQ(turned.b.at(x, y), glm::dvec3(0, 1, 0)) << "the bitangent follows v";
        EXPECT_EQ(turned.n.at(x, y), glm::dvec3(0, 0, 1));
    }
}

TEST(TangentFrames, AreOrthonormalWhereTheyPromiseIt) {
    for (const MeshData& mesh : {shapes::sphere(10, 6), shapes::torus_knot(40, 7)}) {
        EXPECT_GT(skew(Frames(scene_of(mesh, TangentFrames::mikktspace))), 0.01);
        for (const MeshData& m : {mesh, mirrored(mesh)}) {
            EXPECT_LT(skew(Frames(scene_of(m, TangentFrames::orthonormal))), 1e-6);
            EXPECT_LT(skew(Frames(scene_of(m, TangentFrames::derivative))), 1e-6);
        }
    }
}

// From the triangle's corners in double precision: dP/du without its part along the normal; the
// bitangent on the side of dP/dv.
TEST(TangentFrames, OfDerivativesAreTheTriangles) {
    for (const MeshData& mesh :
         {shapes::sphere(10, 6), mirrored(shapes::sphere(10, 6)), shapes::torus_knot(40, 7)}) {
        const Scene scene = scene_of(mesh, TangentFrames::derivative);
        const Frames frames(scene);
        const Picture triangles(scene, Aov::triangle);
        int checked = 0;
        for (int y = 0; y < 64; ++y) {
            for (int x = 0; x < 64; ++x) {
                if (!triangles.covers(x, y)) continue;
                const auto first = 3 * static_cast<std::size_t>(triangles.at(x, y).x);
                glm::dvec3 p[3];
                glm::dvec2 uv[3];
                for (std::size_t i = 0; i < 3; ++i) {
                    p[i] = mesh.positions[mesh.indices[first + i]];
                    uv[i] = mesh.uvs[mesh.indices[first + i]];
                }
                const glm::dmat2 m(uv[1] - uv[0], uv[2] - uv[0]);
                const glm::dmat2 inverse = glm::inverse(m);
                const glm::dvec3 du = (p[1] - p[0]) * inverse[0][0] + (p[2] - p[0]) * inverse[0][1];
                const glm::dvec3 dv = (p[1] - p[0]) * inverse[1][0] + (p[2] - p[0]) * inverse[1][1];
                const glm::dvec3 n = frames.n.at(x, y), t = frames.t.at(x, y);
                const glm::dvec3 want = glm::normalize(du - n * glm::dot(n, du));
                ASSERT_LT(glm::length(t - want), 2e-6) << x << "," << y;
                ASSERT_GT(glm::dot(frames.b.at(x, y), dv), 0.0);
                ++checked;
            }
        }
        EXPECT_GT(checked, 300);
    }
}

TEST(TangentFrames, OfDerivativesNeedNoTangents) {
    MeshData mesh = shapes::torus_knot(40, 7);
    const Frames want(scene_of(mesh, TangentFrames::derivative));
    for (glm::vec4& t : mesh.tangents) t = {0.0F, 0.0F, 0.0F, 1.0F};
    const Frames got(scene_of(mesh, TangentFrames::derivative));
    EXPECT_EQ(got.t, want.t);
    EXPECT_EQ(got.b, want.b);
}

// uv without area say nothing, so the vertices' tangents stay.
TEST(TangentFrames, WithoutUvAreTheVertices) {
    MeshData mesh = shapes::sphere(10, 6);
    for (glm::vec2& uv : mesh.uvs) uv = {0.25F, 0.5F};
    EXPECT_EQ(Picture(scene_of(mesh, TangentFrames::derivative), Aov::tangent),
              Picture(scene_of(mesh, TangentFrames::orthonormal), Aov::tangent));
}

std::vector<float> colors(const Scene& scene, const std::string& isa = {}, int threads = 1) {
    Framebuffer frame(scene.width, scene.height, PixelFormat::rgba32f);
    Renderer({.threads = threads, .isa = isa}).render(scene, frame);
    std::vector<float> pixels;
    for (int y = 0; y < frame.height(); ++y) {
        const auto* row = reinterpret_cast<const float*>(frame.row(y));
        pixels.insert(pixels.end(), row, row + std::ptrdiff_t{4} * frame.width());
    }
    return pixels;
}

// What the light sees is what the picture of the frames shows: the same bits everywhere, the trace
// among them, and other ones in every mode.
TEST(TangentFrames, LightTheSameOnEveryInstructionSetAndInTraces) {
    std::vector<std::vector<float>> seen;
    for (const char* half : {"pixel", "vertex"}) {
        for (const TangentFrames mode : kModes) {
            if (*half == 'v' && mode == TangentFrames::derivative) continue;
            MeshData mesh = mirrored(shapes::sphere(10, 6));
            for (glm::vec4& t : mesh.tangents) t.x += 0.3F;  // tangents that are none
            Scene scene = scene_of(mesh, mode, 40);
            scene.format = PixelFormat::rgba32f;
            choose_half_vector(scene.machine, half);
            const std::vector<float> want = colors(scene, "reference");
            for (const IsaInfo& isa : instruction_sets()) {
                if (!isa.available) continue;
                for (const int threads : {1, 2, 3})
                    EXPECT_EQ(colors(scene, std::string(isa.name), threads), want) << isa.name;
            }
            for (int y = 0; y < 40; y += 3) {
                for (int x = 0; x < 40; x += 2) {
                    const PixelTrace trace = trace_pixel(scene, x, y);
                    for (std::size_t c = 0; c < 4; ++c)
                        ASSERT_EQ(trace.stored[c],
                                  static_cast<double>(
                                      want[static_cast<std::size_t>(4 * (40 * y + x)) + c]));
                    if (!trace.fragment) continue;
                    for (const TracedNumber& n : trace.fragment->color)
                        ASSERT_NEAR(n.error(), 0.0, 2.0 / 255.0);
                }
            }
            for (const std::vector<float>& other : seen) EXPECT_NE(other, want);
            seen.push_back(want);
        }
    }
}

/// Pixels that are lit like their neighbours left and right, and like those above and below.
struct Runs {
    int across = 0, down = 0;
};
Runs runs(const Picture& p) {
    Runs count;
    const auto lit = [&](int x, int y) { return p.pixel(x, y).r > 0.3F; };
    for (int y = 1; y + 1 < p.height(); ++y) {
        for (int x = 1; x + 1 < p.width(); ++x) {
            if (!lit(x, y)) continue;
            count.across += lit(x - 1, y) && lit(x + 1, y) ? 1 : 0;
            count.down += lit(x, y - 1) && lit(x, y + 1) ? 1 : 0;
        }
    }
    return count;
}

// Strokes 14 long and 4 wide: 12 of 14 have both neighbours along, 2 of 4 across. A frame that is
// turned by 90 degrees changes the two.
TEST(TangentFrames, StripesRunAlongTheTangent) {
    for (const TangentFrames mode : kModes) {
        MeshData mesh = shapes::plane(2, 2);
        for (glm::vec3& p : mesh.positions) p *= 4.0F;
        const Runs right = runs(Picture(scene_of(mesh, mode), Aov::stripes));
        EXPECT_GT(right.across, right.down * 3 / 2);
        EXPECT_GT(right.down, 100);
        for (glm::vec2& uv : mesh.uvs) uv = {uv.y, -uv.x};
        for (glm::vec4& t : mesh.tangents) t = {0.0F, 1.0F, 0.0F, 1.0F};
        const Runs turned = runs(Picture(scene_of(mesh, mode), Aov::stripes));
        EXPECT_GT(turned.down, turned.across * 3 / 2);
    }
}

TEST(TangentFrames, StripesPointAndKnowTheirSide) {
    MeshData mesh = shapes::plane(2, 2);
    for (glm::vec3& p : mesh.positions) p *= 4.0F;
    const Picture right(scene_of(mesh, TangentFrames::mikktspace), Aov::stripes);
    const Picture left(scene_of(mirrored(mesh), TangentFrames::mikktspace), Aov::stripes);
    // The first cell of the second block of rows begins 8 pixels to the left.
    EXPECT_GT(right.at(13, 7).r, right.at(2, 7).r) << "brighter where it points";
    EXPECT_GT(left.at(2, 7).r, left.at(13, 7).r);
    EXPECT_EQ(right.at(13, 7).r, right.at(13, 7).b) << "white";
    EXPECT_LT(left.at(13, 7).b, 0.2 * left.at(13, 7).r) << "orange where uv are mirrored";
}

}  // namespace
}  // namespace burnish
