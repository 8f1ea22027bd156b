#include <fmt/format.h>

#include <gtest/gtest.h>
#include <burnish/error.hpp>
#include <burnish/shapes.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include "io/read_mesh.hpp"
#include "io/write_mesh.hpp"
#include "tests/scratch_directory.hpp"

/// Files damaged at random: each gives a mesh that can be drawn, or an Error, and nothing else.
namespace burnish {
namespace {

struct Sample {
    const char* name;
    const char* extension;
    std::string (*bytes)(const MeshData& mesh);
};

std::string off_bytes(const MeshData& mesh) {
    std::string out =
        fmt::format("STNOFF\n{} {} 0\n", mesh.positions.size(), mesh.indices.size() / 3);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const glm::vec3 &p = mesh.positions[i], &n = mesh.normals[i];
        out += fmt::format("{} {} {} {} {} {} {} {}\n", p.x, p.y, p.z, n.x, n.y, n.z, mesh.uvs[i].x,
                           mesh.uvs[i].y);
    }
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        out +=
            fmt::format("3 {} {} {}\n", mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]);
    return out;
}

std::string ply_ascii_bytes(const MeshData& mesh) {
    std::string out = fmt::format(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
        "property float z\nproperty uchar red\nelement face {}\n"
        "property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n",
        mesh.positions.size(), mesh.indices.size() / 3);
    for (const glm::vec3& p : mesh.positions) out += fmt::format("{} {} {} 7\n", p.x, p.y, p.z);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        out +=
            fmt::format("3 {} {} {} 6", mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]);
        for (std::size_t k = i; k < i + 3; ++k)
            out += fmt::format(" {} {}", mesh.uvs[mesh.indices[k]].x, mesh.uvs[mesh.indices[k]].y);
        out += '\n';
    }
    return out;
}

std::string stl_ascii_bytes(const MeshData& mesh) {
    std::string out = "solid sample\n";
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const glm::vec3& p = mesh.positions[mesh.indices[i]];
        if (i % 3 == 0) out += "facet normal 0 0 0\nouter loop\n";
        out += fmt::format("vertex {} {} {}\n", p.x, p.y, p.z);
        if (i % 3 == 2) out += "endloop\nendfacet\n";
    }
    return out + "endsolid sample\n";
}

std::string stl_binary_bytes(const MeshData& mesh) {
    std::string out(80, ' ');
    const auto put = [&](const auto& value) {
        out.append(reinterpret_cast<const char*>(&value), sizeof(value));
    };
    put(static_cast<std::uint32_t>(mesh.indices.size() / 3));
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        if (i % 3 == 0) put(glm::vec3(0.0F));
        put(mesh.positions[mesh.indices[i]]);
        if (i % 3 == 2) put(std::uint16_t{0});
    }
    return out;
}

const Sample kGenerated[] = {{"off", ".off", off_bytes},
                             {"ply_ascii", ".ply", ply_ascii_bytes},
                             {"stl_ascii", ".stl", stl_ascii_bytes},
                             {"stl_binary", ".stl", stl_binary_bytes}};

/// One to three of: a bit flipped, a byte replaced, bytes inserted or removed, a block repeated,
/// the end cut off, a run of text replaced by something that parsers trip over.
std::string mutate(std::string bytes, std::mt19937& engine) {
    static constexpr std::array<const char*, 12> kTraps = {
        "nan", "-1", "4294967295",  "1e400", "99999999999999999999", "\\\n", "\n\n",
        "inf", "/",  "-2147483648", "0",     "3 3 3 3 3 3"};
    const auto steps = 1 + engine() % 3;
    for (auto left = steps; left > 0 && !bytes.empty(); --left) {
        // Headers are short but matter most: every fourth change hits the first 300 bytes.
        const std::size_t reach =
            engine() % 4 != 0 ? bytes.size() : std::min<std::size_t>(300, bytes.size());
        const std::size_t at = engine() % reach;
        switch (engine() % 7) {
            case 0:
                bytes[at] = static_cast<char>(bytes[at] ^ (1 << engine() % 8));
                break;
            case 1:
                bytes[at] = static_cast<char>(engine() % 256);
                break;
            case 2:
                bytes.insert(at, 1 + engine() % 5, static_cast<char>(engine() % 256));
                break;
            case 3:
                bytes.erase(at, 1 + engine() % 20);
                break;
            case 4:
                bytes.insert(at, bytes.substr(at, 1 + engine() % 200));
                break;
            case 5:
                bytes.resize(at);
                break;
            default:
                bytes.replace(at, engine() % 4, kTraps[engine() % kTraps.size()]);
                break;
        }
    }
    return bytes;
}

class MeshMutations : public ScratchDirectory {
  protected:
    void expect_mesh_or_error(const std::string& extension, const std::string& bytes,
                              const std::string& which) {
        const std::filesystem::path file = path("sample" + extension);
        write(file, bytes);
        try {
            const LoadedMesh loaded = read_mesh_file(file);
            ++m_loaded;
            EXPECT_GT(loaded.mesh.triangle_count(), 0U) << which;
            EXPECT_EQ(loaded.mesh.triangle_count(), loaded.report.triangles) << which;
            for (const VertexFrame& frame : loaded.mesh.frames()) {
                const glm::dvec3 n(frame.normal), t(frame.tangent);
                ASSERT_NEAR(glm::dot(n, n), 1.0, 1e-5) << which;
                ASSERT_NEAR(glm::dot(t, t), 1.0, 1e-5) << which;
                ASSERT_TRUE(std::isfinite(frame.position.x + frame.uv.x + frame.uv.y)) << which;
            }
        } catch (const Error& error) {
            ++m_refused;
            EXPECT_EQ(error.code(), ErrorCode::bad_input) << which << ": " << error.what();
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << which;
        }
    }

    void run(const std::string& name, const std::string& extension, const std::string& intact) {
        constexpr unsigned kMutations = 400;
        for (unsigned seed = 0; seed < kMutations; ++seed) {
            std::mt19937 engine(seed);
            expect_mesh_or_error(extension, mutate(intact, engine),
                                 fmt::format("{} seed {}", name, seed));
        }
        // Both outcomes happen, or the mutations test nothing.
        EXPECT_GT(m_loaded, 4U) << name;
        EXPECT_GT(m_refused, 4U) << name;
    }

    unsigned m_loaded = 0;
    unsigned m_refused = 0;
};

TEST_F(MeshMutations, GeneratedFormats) {
    for (const Sample& sample : kGenerated) {
        m_loaded = m_refused = 0;
        run(sample.name, sample.extension, sample.bytes(shapes::sphere(8, 5)));
    }
}

TEST_F(MeshMutations, WrittenFormats) {
    for (const char* extension : {".obj", ".ply"}) {
        write_mesh_file(shapes::sphere(8, 5), path(std::string("intact") + extension));
        m_loaded = m_refused = 0;
        run(extension, extension, read(path(std::string("intact") + extension)));
    }
}

TEST_F(MeshMutations, ObjWithEverything) {
    const std::string text =
        "# comment\nmtllib a.mtl\no thing\nv 0 0 0 1\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\n"
        "vt 0 0 0\nvt 1 0\nvt 1 1\nvt 0.5\nvn 0 0 1\nvn 1 0 0\ng a b\ns 1\nusemtl x\n"
        "f 1/1/1 2/2/1 3/3/1 4/4/1\nf -1 -2 -3\nf 1//2 2//2 \\\n 5//2\nf 3/3 4/4 5/2\nl 1 2\n";
    run("obj_everything", ".obj", text);
}

/// Bytes of nothing in particular under every extension.
TEST_F(MeshMutations, Noise) {
    for (unsigned seed = 0; seed < 200; ++seed) {
        std::mt19937 engine(seed);
        std::string bytes(engine() % 2000, '\0');
        for (char& byte : bytes) byte = static_cast<char>(engine() % 256);
        static constexpr std::array<const char*, 6> kStarts = {"",       "ply\n", "OFF\n",
                                                               "solid ", "v ",    "OFF BINARY\n"};
        bytes.insert(0, kStarts[seed % kStarts.size()]);
        for (const char* extension : {".obj", ".ply", ".off", ".stl"})
            expect_mesh_or_error(extension, bytes, fmt::format("{} seed {}", extension, seed));
    }
}

/// Shapes that invite square time: one vertex in every face, one edge in every face, one polygon
/// with every vertex, faces that repeat, a line continued without end.
TEST_F(MeshMutations, LargeAndCrooked) {
    constexpr int kCount = 100'000;
    std::string fan = "v 0 0 0\nv 0 0 1\n", book = fan, polygon = "f", repeated = "v 1 0 0\n" + fan;
    std::string star = "v 0 0 0\n";
    for (int i = 0; i < kCount; ++i) {
        const std::string vertex = fmt::format("v {} {} 0\n", 1 + i % 317, 1 + i / 317);
        fan += vertex;
        book += vertex;
        star += fmt::format("v {} {} 0\n", i % 2 == 0 ? i : -i, i * 7919 % 1009);
        polygon += fmt::format(" {}", i + 1);
        repeated += "f 1 2 3\n";
    }
    for (int i = 3; i < kCount; ++i) {
        fan += fmt::format("f 1 {} {}\n", i, i + 1);
        book += fmt::format("f 1 2 {}\n", i);
    }
    expect_mesh_or_error(".obj", fan, "fan");
    expect_mesh_or_error(".obj", book, "book");
    expect_mesh_or_error(".obj", repeated, "repeated");
    expect_mesh_or_error(".obj", star + polygon + "\n", "polygon");
    // As many corners as are clipped, and hardly an ear among them.
    for (int i = 0; i < 50; ++i) {
        star += "f";
        for (int k = 0; k < 1024; ++k) star += fmt::format(" {}", (i + k * 6007) % kCount + 1);
        star += "\n";
    }
    expect_mesh_or_error(".obj", star, "tangles");
    std::string continued = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3";
    for (int i = 0; i < kCount; ++i) continued += "\\\n";
    expect_mesh_or_error(".obj", continued, "continued");
    EXPECT_EQ(m_loaded, 6U);
}

}  // namespace
}  // namespace burnish
