#include "io/read_mesh.hpp"

#include <fmt/format.h>

#include <gtest/gtest.h>
#include <burnish/error.hpp>
#include <burnish/shapes.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <tuple>

#include "io/write_mesh.hpp"
#include "tests/scratch_directory.hpp"

namespace burnish {
namespace {

class MeshRead : public ScratchDirectory {
  protected:
    LoadedMesh load(const std::string& name, const std::string& bytes) {
        write(path(name), bytes);
        return read_mesh_file(path(name));
    }

    /// The message of the error that loading throws, with the directory taken off.
    std::string error_of(const std::string& name, const std::string& bytes) {
        try {
            load(name, bytes);
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::bad_input);
            std::string text = error.what();
            const std::string prefix = directory().string() + "/";
            EXPECT_TRUE(text.starts_with(prefix)) << text;
            return text.substr(std::min(prefix.size(), text.size()));
        }
        return "no error";
    }
};

/// Corner k of the mesh as it will be drawn.
const VertexFrame& corner(const Mesh& mesh, std::size_t k) {
    return mesh.frames()[mesh.indices()[k]];
}

template <class T>
void append(std::string& bytes, T value, std::endian order) {
    auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
    bytes.append(raw.data(), raw.size());
}

constexpr const char* kTwoTriangles = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";

// ---- OBJ

TEST_F(MeshRead, ObjKeepsCornersApartAtASeam) {
    // Both triangles use vertices 1 and 3, with other uvs in each.
    const LoadedMesh loaded = load("a.obj",
                                   "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                   "vt 0 0\nvt 1 0\nvt 1 1\nvt 5 5\nvt 6 6\nvt 5 6\nvn 0 0 1\n"
                                   "f 1/1/1 2/2/1 3/3/1\nf 1/4/1 3/5/1 4/6/1\n");
    EXPECT_EQ(loaded.mesh.vertex_count(), 6U);
    EXPECT_EQ(corner(loaded.mesh, 0).uv, glm::vec2(0, 0));
    EXPECT_EQ(corner(loaded.mesh, 3).uv, glm::vec2(5, 5));
    EXPECT_EQ(corner(loaded.mesh, 4).uv, glm::vec2(6, 6));
    EXPECT_EQ(corner(loaded.mesh, 0).position, corner(loaded.mesh, 3).position);
    EXPECT_FALSE(loaded.report.generated_normals);
    EXPECT_FALSE(loaded.report.generated_uvs);
    EXPECT_EQ(loaded.report.boundary_edges, 4U);  // the diagonal has a triangle on both sides
    EXPECT_TRUE(loaded.report.notes().empty());
}

TEST_F(MeshRead, ObjPolygonKeepsTheDataOfItsCorners) {
    std::string text;
    for (int i = 0; i < 6; ++i) {
        const double angle = i * std::acos(-1.0) / 3.0;
        text += fmt::format("v {} {} 0\nvt 0.{} 0.5\nvn 0 0.{} 1\n", std::cos(angle),
                            std::sin(angle), i + 1, i);
    }
    const LoadedMesh loaded = load("a.obj", text + "f 1/1/1 2/2/2 3/3/3 4/4/4 5/5/5 6/6/6\n");
    EXPECT_EQ(loaded.report.polygons, 1U);
    EXPECT_EQ(loaded.mesh.triangle_count(), 4U);
    for (std::size_t k = 0; k < 12; ++k) {
        const VertexFrame& frame = corner(loaded.mesh, k);
        // Corner i has u = (i + 1) / 10 and a normal that leans by i / 10.
        const double i = std::round(10.0 * static_cast<double>(frame.uv.x)) - 1.0;
        EXPECT_NEAR(frame.position.x, std::cos(i * std::acos(-1.0) / 3.0), 1e-5);
        EXPECT_NEAR(frame.normal.y / frame.normal.z, i / 10.0, 1e-5);
    }
}

TEST_F(MeshRead, ObjConcavePolygonIsCoveredOnce) {
    // An arrowhead whose fan from the first corner would reach outside.
    const LoadedMesh loaded =
        load("a.obj", "v 0 2 0\nv -1 0 0\nv 0 1 0\nv 1 0 0\nf 2 3 4 1\nf 1 2 3 4\n");
    double area = 0.0;
    for (std::size_t k = 0; k < loaded.mesh.indices().size(); k += 3) {
        const glm::dvec3 a(corner(loaded.mesh, k).position), b(corner(loaded.mesh, k + 1).position),
            c(corner(loaded.mesh, k + 2).position);
        const double z = glm::cross(b - a, c - a).z;
        EXPECT_GT(z, 0.0);
        area += 0.5 * z;
    }
    EXPECT_DOUBLE_EQ(area, 2.0 * 1.0);  // a triangle of area 2 less one of area 1, twice
}

TEST_F(MeshRead, ObjIndexForms) {
    const std::string header = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\n";
    const LoadedMesh want = load("a.obj", header + "f 1/1/1 2/2/1 3/3/1\n");
    for (const char* face : {"f -3/-3/-1 -2/-2/-1 -1/-1/-1\n", "f\t1/1/1   2/2/1 3/3/1  \r\n",
                             "f 1/1/1 \\\n 2/2/1 \\\r\n 3/3/1\n", "f 1/1/1 2/2/1 3/3/1 # comment",
                             "f 1/1 2/2 3/3", "g x\ns 1\nusemtl y\nf 1/1/1 2/2/1 3/3/1\nl 1 2\n"}) {
        const LoadedMesh got = load("b.obj", header + face);
        ASSERT_EQ(got.mesh.vertex_count(), 3U) << face;
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(corner(got.mesh, k).position, corner(want.mesh, k).position) << face;
            EXPECT_EQ(corner(got.mesh, k).uv, corner(want.mesh, k).uv) << face;
            EXPECT_EQ(corner(got.mesh, k).normal, corner(want.mesh, k).normal) << face;
        }
    }
    EXPECT_TRUE(load("c.obj", header + "f 1//1 2//1 3//1\n").report.generated_uvs);
    EXPECT_TRUE(load("c.obj", header + "f 1 2 3\n").report.generated_normals);
    // A face may stand before what it uses.
    EXPECT_EQ(load("c.obj", "f 1/1/1 2/2/1 3/3/1\n" + header).mesh.triangle_count(), 1U);
}

TEST_F(MeshRead, ObjNonFiniteVertexDoesNotShiftIndices) {
    const LoadedMesh loaded = load("a.obj",
                                   "v nan 0 0\nv 0 0 0\nv 1e400 0 0\nv 1 0 0\nv -inf 0 0\n"
                                   "v 1.#IND 0 0\nv 0 1 0\nf 2 4 7\nf 1 2 4\nf 3 4 7\nf 5 6 7\n");
    EXPECT_EQ(loaded.report.nonfinite_vertices, 4U);
    EXPECT_EQ(loaded.report.nonfinite_faces, 3U);
    ASSERT_EQ(loaded.mesh.triangle_count(), 1U);
    EXPECT_EQ(corner(loaded.mesh, 1).position, glm::vec3(1, 0, 0));
    EXPECT_EQ(corner(loaded.mesh, 2).position, glm::vec3(0, 1, 0));
    for (const VertexFrame& frame : loaded.mesh.frames())
        EXPECT_TRUE(std::isfinite(frame.uv.x) && std::isfinite(frame.uv.y));
    EXPECT_EQ(loaded.report.notes().back(), "4 vertices are not finite: 3 faces skipped");
}

TEST_F(MeshRead, ObjErrorsNameTheLine) {
    EXPECT_EQ(error_of("a.obj", "v 0 0 0\nv 1 0\n"),
              "a.obj:2: found the end of the line, expected a number");
    EXPECT_EQ(error_of("a.obj", "v 0 0 0\n\nv 1 zero 0\n"),
              "a.obj:3: found 'zero', expected a number");
    EXPECT_EQ(error_of("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"),
              "a.obj:4: vertex index 4, expected 1 to 3");
    EXPECT_EQ(error_of("a.obj", "v 0 0 0\nv 1 0 0\nf -1 -2 -3\nv 0 0 1\n"),
              "a.obj:3: vertex index -3, expected at least -2");
    EXPECT_EQ(error_of("a.obj", "v 0 0 0\nf 0 1 1\n"), "a.obj:2: vertex index 0, expected 1 to 1");
    EXPECT_EQ(error_of("a.obj", "v 0 0 0\nf 1/1 1/1 1/1\n"),
              "a.obj:2: uv index 1, but the file has no uv");
    EXPECT_EQ(error_of("a.obj", "v 0 0 0\nf 1 a/b 1\n"),
              "a.obj:2: found 'a/b', expected a corner such as 1, 1/2, 1//3 or 1/2/3");
    EXPECT_EQ(error_of("a.obj", "v 0 0 0\nv 1 0 0\n"), "a.obj: no triangle to draw");
    EXPECT_EQ(error_of("a.obj", ""), "a.obj: no triangle to draw");
}

// ---- what all formats share

TEST_F(MeshRead, NonManifoldFacesAreDrawnAndCounted) {
    // Three triangles on one edge: the third has no place in a half-edge structure.
    const LoadedMesh loaded = load("a.obj",
                                   "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\n"
                                   "f 1 2 3\nf 2 1 4\nf 1 2 5\n");
    EXPECT_EQ(loaded.report.nonmanifold_faces, 1U);
    EXPECT_EQ(loaded.report.triangles, 3U);
    EXPECT_EQ(loaded.mesh.triangle_count(), 3U);
    EXPECT_EQ(loaded.report.notes().back(), "1 face is not manifold: drawn all the same");
}

TEST_F(MeshRead, FacesWithoutAreaAreSkippedAndCounted) {
    const LoadedMesh loaded = load("a.obj",
                                   "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nv 0 0 0\n"
                                   "f 1 2 3\nf 1 2 4\nf 1 1 2\nf 1 2\nf 1 5 3\n");
    EXPECT_EQ(loaded.report.polygons, 5U);
    EXPECT_EQ(loaded.report.degenerate_faces, 4U);
    EXPECT_EQ(loaded.mesh.triangle_count(), 1U);
    EXPECT_EQ(error_of("b.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"),
              "b.obj: no triangle to draw");
}

TEST_F(MeshRead, CornerInTheMiddleOfAnEdgeLeavesNoCrack) {
    // A quadrilateral whose second corner lies on the edge from the first to the third: the sliver
    // without area stays, so that both halves of the edge are drawn.
    const LoadedMesh loaded = load("a.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3 4\n");
    EXPECT_EQ(loaded.report.degenerate_faces, 0U);
    EXPECT_EQ(loaded.mesh.triangle_count(), 2U);
}

TEST_F(MeshRead, BoundaryEdgesAreCountedByPlace) {
    EXPECT_EQ(load("a.obj", kTwoTriangles).report.boundary_edges, 4U);
    // The sphere's file has its seam's vertices twice; in space it is closed all the same.
    write_mesh_file(shapes::sphere(12, 6), path("sphere.ply"));
    const LoadedMesh loaded = read_mesh_file(path("sphere.ply"));
    EXPECT_EQ(loaded.report.boundary_edges, 0U);
    EXPECT_EQ(loaded.report.nonmanifold_faces, 0U);
}

TEST_F(MeshRead, MissingNormalsKeepSharpEdgesAndSmoothOthers) {
    const LoadedMesh cube = load("cube.off",
                                 "OFF\n8 6 12\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n"
                                 "0 1 1\n4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n"
                                 "4 3 0 4 7\n");
    EXPECT_TRUE(cube.report.generated_normals);
    EXPECT_EQ(cube.report.boundary_edges, 0U);
    for (const VertexFrame& frame : cube.mesh.frames())
        EXPECT_EQ(glm::abs(frame.normal.x) + glm::abs(frame.normal.y) + glm::abs(frame.normal.z),
                  1.0F);
    // A roof of 20 degrees: at the ridge both sides share one normal, straight up.
    const LoadedMesh roof = load("roof.obj",
                                 "v 0 0 0.17632698\nv 0 1 0.17632698\nv 1 0 0\nv 1 1 0\nv -1 0 0\n"
                                 "v -1 1 0\nf 1 3 4 2\nf 5 1 2 6\n");
    EXPECT_NEAR(corner(roof.mesh, 0).normal.z, 1.0, 1e-6);
    EXPECT_NEAR(corner(roof.mesh, 1).normal.z, std::cos(std::acos(-1.0) / 18.0), 1e-6);
}

TEST_F(MeshRead, MissingNormalsAreWeightedByAngle) {
    // Three faces at the origin: two halves of a square in z = 0 (45 degrees each) and a triangle
    // that leans by 40 degrees about the y axis (90 degrees). Areas differ by a factor of ten.
    const double lean = std::acos(-1.0) * 40.0 / 180.0;
    const LoadedMesh loaded =
        load("a.obj", fmt::format("v 0 0 0\nv 0 1 0\nv -1 1 0\nv -1 0 0\nv {} 0 {}\n"
                                  "f 1 2 3\nf 1 3 4\nf 1 5 2\n",
                                  10.0 * std::cos(lean), -10.0 * std::sin(lean)));
    // Half of the right angles each: the normal leans by half.
    const VertexFrame& frame = corner(loaded.mesh, 0);
    EXPECT_NEAR(frame.normal.x, std::sin(lean / 2), 1e-6);
    EXPECT_NEAR(frame.normal.z, std::cos(lean / 2), 1e-6);
}

TEST_F(MeshRead, GivenNormalsAreMadeUnitAndZeroOnesReplaced) {
    const LoadedMesh loaded = load("a.obj",
                                   "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 5\nvn 0 0 0\nvn nan 0 1\n"
                                   "f 1//1 2//2 3//3\n");
    EXPECT_TRUE(loaded.report.generated_normals);
    for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(corner(loaded.mesh, k).normal, glm::vec3(0, 0, 1));
}

TEST_F(MeshRead, MadeUvsHaveBoundedStretchAndNoMirroring) {
    MeshData sphere = shapes::sphere(48, 24, {2.0F, 1.0F, 1.5F});
    std::string text =
        fmt::format("OFF\n{} {} 0\n", sphere.positions.size(), sphere.indices.size() / 3);
    for (const glm::vec3& p : sphere.positions) text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
    for (std::size_t i = 0; i < sphere.indices.size(); i += 3)
        text += fmt::format("3 {} {} {}\n", sphere.indices[i], sphere.indices[i + 1],
                            sphere.indices[i + 2]);
    const LoadedMesh loaded = load("sphere.off", text);
    EXPECT_TRUE(loaded.report.generated_uvs);
    double longest_edge = 0.0;
    for (std::size_t k = 0; k < loaded.mesh.indices().size(); ++k) {
        const VertexFrame& a = corner(loaded.mesh, k);
        const VertexFrame& b = corner(loaded.mesh, k % 3 == 2 ? k - 2 : k + 1);
        EXPECT_EQ(a.tangent.w, 1.0F);
        ASSERT_TRUE(a.uv.x >= 0.0F && a.uv.x <= 1.0F && a.uv.y >= 0.0F && a.uv.y <= 1.0F);
        // The longest side of the box is 4: one period.
        const double in_space = glm::length(glm::dvec3(b.position - a.position)) / 4.0;
        const double in_uv = glm::length(glm::dvec2(b.uv - a.uv));
        ASSERT_LE(in_uv, in_space * 1.0001);
        longest_edge = std::max(longest_edge, in_space / std::max(in_uv, 1e-9));
    }
    EXPECT_LT(longest_edge, 3.3);
    // Away from the ends, tangents are level: brush marks run around the object.
    for (const VertexFrame& frame : loaded.mesh.frames())
        EXPECT_TRUE(std::abs(frame.normal.y) > 0.8F || std::abs(frame.tangent.y) < 0.05F);
}

TEST_F(MeshRead, UnknownContentsNameTheKnownFormats) {
    EXPECT_EQ(error_of("a.xyz", "1 2 3\n"),
              "a.xyz: unknown mesh format, expected OBJ, PLY, OFF or STL (extension '.xyz')");
    EXPECT_EQ(error_of("a", ""),
              "a: unknown mesh format, expected OBJ, PLY, OFF or STL (extension '')");
    // By content, whatever the extension says.
    EXPECT_EQ(load("a.txt", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").mesh.triangle_count(),
              1U);
    EXPECT_EQ(load("B.OBJ", kTwoTriangles).mesh.triangle_count(), 2U);
}

TEST_F(MeshRead, FilesThatCannotBeRead) {
    const auto code = [](const std::filesystem::path& file) {
        try {
            read_mesh_file(file);
        } catch (const Error& error) {
            return error.code();
        }
        return ErrorCode::limit;
    };
    EXPECT_EQ(code(path("none.obj")), ErrorCode::io);
    EXPECT_EQ(code(directory()), ErrorCode::io);
    EXPECT_EQ(code("/dev/zero"), ErrorCode::io);  // would never end
}

// ---- PLY

std::string ply_header(const std::string& format, const std::string& vertex_properties,
                       const std::string& face_properties, int vertices = 3, int faces = 1) {
    return fmt::format(
        "ply\nformat {} 1.0\ncomment made by hand\nelement vertex {}\n"
        "property float x\nproperty float y\nproperty float z\n{}element face {}\n"
        "property list uchar int vertex_indices\n{}end_header\n",
        format, vertices, vertex_properties, faces, face_properties);
}

TEST_F(MeshRead, PlyAsciiWithEveryNameOfUv) {
    using Names = std::pair<const char*, const char*>;
    for (const auto& [u, v] : {Names{"u", "v"}, Names{"s", "t"}, Names{"texture_u", "texture_v"}}) {
        const LoadedMesh loaded =
            load("a.ply", ply_header("ascii",
                                     fmt::format("property float nx\nproperty float ny\n"
                                                 "property float nz\nproperty uchar red\n"
                                                 "property float {}\nproperty double {}\n",
                                                 u, v),
                                     "") +
                              "0 0 0 0 0 1 255 0 0.25\n1 0 0 0 0 1 255 1 0.25\r\n"
                              "0 1 0 0 0 1 255 0 0.75\n3 0 1 2\n");
        EXPECT_FALSE(loaded.report.generated_uvs) << u;
        EXPECT_FALSE(loaded.report.generated_normals);
        EXPECT_EQ(corner(loaded.mesh, 2).uv, glm::vec2(0.0F, 0.75F));
        EXPECT_EQ(corner(loaded.mesh, 1).position, glm::vec3(1, 0, 0));
    }
}

TEST_F(MeshRead, PlyUvsOfFacesKeepSeams) {
    const LoadedMesh loaded =
        load("a.ply", ply_header("ascii", "", "property list uchar float texcoord\n", 4, 2) +
                          "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
                          "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 5 5 6 6 5 6\n");
    EXPECT_FALSE(loaded.report.generated_uvs);
    EXPECT_EQ(corner(loaded.mesh, 2).uv, glm::vec2(1, 1));
    EXPECT_EQ(corner(loaded.mesh, 3).uv, glm::vec2(5, 5));
    EXPECT_EQ(loaded.mesh.vertex_count(), 6U);
}

TEST_F(MeshRead, PlyBinaryOfBothByteOrders) {
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        const bool little = order == std::endian::little;
        std::string bytes =
            ply_header(little ? "binary_little_endian" : "binary_big_endian",
                       "property short u\nproperty double v\n", "property ushort material\n", 4);
        for (int i = 0; i < 4; ++i) {
            append(bytes, static_cast<float>(i == 1 || i == 2), order);
            append(bytes, static_cast<float>(i >= 2), order);
            append(bytes, 0.5F, order);
            append(bytes, static_cast<std::int16_t>(-i), order);
            append(bytes, 0.25 * i, order);
        }
        bytes += '\4';
        for (std::int32_t i = 0; i < 4; ++i) append(bytes, i, order);
        append(bytes, std::uint16_t{7}, order);
        const LoadedMesh loaded = load("a.ply", bytes);
        ASSERT_EQ(loaded.mesh.triangle_count(), 2U);
        EXPECT_EQ(corner(loaded.mesh, 2).position, glm::vec3(1.0F, 1.0F, 0.5F));
        EXPECT_EQ(corner(loaded.mesh, 2).uv, glm::vec2(-2.0F, 0.5F));
    }
}

TEST_F(MeshRead, PlyErrors) {
    const std::string body = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    EXPECT_EQ(error_of("a.ply", ply_header("ascii", "", "") + "0 0 0\n1 0 0\n0 x 0\n3 0 1 2\n"),
              "a.ply:13: found 'x', expected a number");
    EXPECT_EQ(error_of("a.ply", ply_header("ascii", "", "") + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
              "a.ply:14: face 0: vertex index 3, but the file has 3 vertices");
    EXPECT_EQ(error_of("a.ply", ply_header("ascii", "", "") + "0 0 0\n1 0 0\n0 1 0\n3 0 1"),
              "a.ply:14: face 0: a list of 3, which the file is too short for");
    EXPECT_EQ(error_of("a.ply", ply_header("ascii", "", "") + "0 0 0\n1 0 0\n0 1 0\n"),
              "a.ply:14: found the end of the file, expected a whole number");
    EXPECT_EQ(error_of("a.ply", ply_header("ascii", "", "", 2'000'000'000) + body),
              "a.ply:4: 2000000000 elements 'vertex', but only 26 bytes follow the header");
    EXPECT_EQ(error_of("a.ply", ply_header("binary_little_endian", "", "", 2, 0) + body.substr(3)),
              "a.ply:4: 2 elements 'vertex', but only 23 bytes follow the header");
    EXPECT_EQ(error_of("a.ply", "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\n"),
              "a.ply:4: the file ends before 'end_header'");
    EXPECT_EQ(error_of("a.ply",
                       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                       "property float y\nend_header\n" +
                           body),
              "a.ply:3: element 'vertex' lacks the property 'z'");
    EXPECT_EQ(error_of("a.ply", "ply\nformat jpeg 1.0\n"),
              "a.ply:2: found 'jpeg', expected ascii, binary_little_endian or binary_big_endian");
    EXPECT_EQ(error_of("a.ply", "plywood"), "a.ply:1: expected 'ply' on the first line");
}

// ---- OFF

TEST_F(MeshRead, OffVariants) {
    const LoadedMesh plain = load("a.off",
                                  "# comment\nOFF # text\n\n3 1 0\n0 0 0 255 0 0\n1 0 0\n"
                                  "# between\n0 1 0\n3 0 1 2 0.5 0.5 0.5\n");
    EXPECT_EQ(plain.mesh.triangle_count(), 1U);
    const LoadedMesh bare = load("a.off", "3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    EXPECT_EQ(bare.mesh.triangle_count(), 1U);
    const LoadedMesh one_line = load("a.off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    EXPECT_EQ(one_line.mesh.triangle_count(), 1U);
    const LoadedMesh all = load("a.off",
                                "STCN4OFF\n3 1 0\n0 0 0 2 0 0 1 1 1 1 0.1 0.2\n"
                                "2 0 0 2 0 0 1 1 1 1 1 0.3 0.4\n0 2 0 2 0 0 1 1 1 1 0.5 0.6\n"
                                "3 0 1 2\n");
    EXPECT_FALSE(all.report.generated_uvs);
    EXPECT_FALSE(all.report.generated_normals);
    EXPECT_EQ(corner(all.mesh, 1).position, glm::vec3(1, 0, 0));  // (2, 0, 0) / 2
    EXPECT_EQ(corner(all.mesh, 1).uv, glm::vec2(0.3F, 0.4F));
    EXPECT_EQ(corner(all.mesh, 2).uv, glm::vec2(0.5F, 0.6F));
}

TEST_F(MeshRead, OffErrors) {
    EXPECT_EQ(error_of("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"),
              "a.off:6: vertex index -1, but the file has 3 vertices");
    EXPECT_EQ(error_of("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n"),
              "a.off:4: the file ends before vertex 2 of 3");
    EXPECT_EQ(error_of("a.off", "OFF\n4000000000 1 0\n0 0 0\n"),
              "a.off:2: 4000000000 vertices in a file of 25 bytes");
    EXPECT_EQ(error_of("a.off", "OFF\n1 1 0\n0 0 0\n999999 0\n"),
              "a.off:4: found the end of the line, expected a whole number");
    EXPECT_EQ(error_of("a.off", "OFF BINARY\n"), "a.off:1: binary OFF, expected the text form");
}

// ---- STL

std::string stl_facet(const std::string& corners) {
    return "facet normal 0 0 0\n outer loop\n" + corners + " endloop\nendfacet\n";
}

TEST_F(MeshRead, StlMergesEqualPlaces) {
    const LoadedMesh ascii = load(
        "a.stl", "solid two\n" + stl_facet("vertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n") +
                     stl_facet("vertex 0 -0 0\nvertex 1 1 0\nvertex 0 1 0\n") + "endsolid two\n");
    EXPECT_EQ(ascii.mesh.vertex_count(), 4U);
    EXPECT_EQ(ascii.report.boundary_edges, 4U);
    EXPECT_TRUE(ascii.report.generated_normals);

    std::string bytes = "solid, but binary";
    bytes.resize(80);
    append(bytes, std::uint32_t{2}, std::endian::little);
    for (const glm::vec3 p :
         {glm::vec3(0, 0, 1), glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(1, 1, 0),
          glm::vec3(9, 9, 9), glm::vec3(0, 0, 0), glm::vec3(1, 1, 0), glm::vec3(0, 1, 0)}) {
        if (p.x == 9.0F) bytes += std::string(2, '\0');
        for (int i = 0; i < 3; ++i) append(bytes, p[i], std::endian::little);
    }
    bytes += std::string(2, '\0');
    const LoadedMesh binary = load("b.stl", bytes);
    EXPECT_EQ(binary.mesh.vertex_count(), 4U);
    for (std::size_t k = 0; k < 6; ++k)
        EXPECT_EQ(corner(binary.mesh, k).position, corner(ascii.mesh, k).position);
}

TEST_F(MeshRead, StlErrors) {
    EXPECT_EQ(error_of("a.stl", "solid x\nfacet normal 0 0 1\nvertex 0 0 0\n"),
              "a.stl:3: a vertex outside 'outer loop' and 'endloop'");
    EXPECT_EQ(error_of("a.stl", "solid x\nouter loop\nvertex 0 0\n"),
              "a.stl:3: found the end of the line, expected a number");
    EXPECT_EQ(error_of("a.stl", "solid x\nouter loop\n"),
              "a.stl:2: the file ends before 'endloop'");
    EXPECT_EQ(error_of("a.stl", "solid x\nbanana\n"),
              "a.stl:2: found 'banana', expected 'facet', 'vertex' or the like");
    EXPECT_EQ(error_of("a.stl", std::string(80, ' ') + std::string("\2\0\0\0", 4)),
              "a.stl: 84 bytes, expected 184 for 2 facets");
    EXPECT_EQ(error_of("a.stl", "short"),
              "a.stl: 5 bytes, expected a header of 84, or text that begins with 'solid'");
}

// ---- round trip, size

using FrameKey = std::tuple<float, float, float, float, float, float, float, float>;

FrameKey key_of(const glm::vec3& p, const glm::vec3& n, const glm::vec2& uv) {
    return {p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y};
}

TEST_F(MeshRead, WhatWasWrittenIsReadBackBitForBit) {
    const MeshData mesh = shapes::torus_knot(40, 9);
    for (const char* name : {"knot.ply", "knot.obj"}) {
        write_mesh_file(mesh, path(name));
        const LoadedMesh loaded = read_mesh_file(path(name));
        ASSERT_EQ(loaded.mesh.indices().size(), mesh.indices.size());
        for (std::size_t k = 0; k < mesh.indices.size(); ++k) {
            const std::uint32_t i = mesh.indices[k];
            const VertexFrame& got = corner(loaded.mesh, k);
            ASSERT_EQ(key_of(got.position, got.normal, got.uv),
                      key_of(mesh.positions[i], mesh.normals[i], mesh.uvs[i]))
                << name << " corner " << k;
            ASSERT_GT(glm::dot(glm::vec3(got.tangent), glm::vec3(mesh.tangents[i])), 0.9F);
        }
    }
    EXPECT_EQ(entries(), (std::vector<std::string>{"knot.obj", "knot.ply"}));
}

TEST_F(MeshRead, StoredMeshesAreWhatTheirFormulasGive) {
    const std::filesystem::path stored = std::filesystem::path(BURNISH_SOURCE_DIR) / "meshes";
    const std::pair<const char*, MeshData> made[] = {{"sphere.ply", shapes::sphere(64, 32)},
                                                     {"knot.obj", shapes::torus_knot(96, 12)},
                                                     {"cube.obj", shapes::cube()}};
    for (const auto& [name, mesh] : made) {
        write_mesh_file(mesh, path(name));
        EXPECT_TRUE(read(path(name)) == read(stored / name)) << name;
        EXPECT_TRUE(read_mesh_file(stored / name).report.notes().empty()) << name;
    }
    const MeshReport by_hand = read_mesh_file(stored / "cube.off").report;
    EXPECT_EQ(by_hand.polygons, 6U);
    EXPECT_EQ(by_hand.boundary_edges, 0U);
    EXPECT_EQ(by_hand.notes().size(), 2U);  // normals and uvs were made up
}

TEST_F(MeshRead, WriteRefusesOtherFormats) {
    try {
        write_mesh_file(shapes::cube(), path("cube.stl"));
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::bad_option);
    }
    EXPECT_THROW(write_mesh_file(shapes::cube(), path("none/cube.ply")), Error);
    EXPECT_TRUE(entries().empty());
}

TEST_F(MeshRead, MillionTriangles) {
    write_mesh_file(shapes::torus_knot(1000, 500), path("knot.ply"));
    const LoadedMesh loaded = read_mesh_file(path("knot.ply"));
    EXPECT_EQ(loaded.mesh.triangle_count(), 1'000'000U);
    EXPECT_EQ(loaded.mesh.vertex_count(), 1001U * 501U);
    EXPECT_EQ(loaded.report.boundary_edges, 0U);
    EXPECT_TRUE(loaded.report.notes().empty());
    for (const VertexFrame& frame : loaded.mesh.frames()) {
        const glm::dvec3 t(frame.tangent);
        ASSERT_NEAR(glm::dot(t, t), 1.0, 1e-6);
        ASSERT_NEAR(glm::dot(t, glm::dvec3(frame.normal)), 0.0, 1e-6);
        ASSERT_EQ(frame.tangent.w, 1.0F);
    }
}

}  // namespace
}  // namespace burnish
