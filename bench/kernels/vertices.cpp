#include <cstring>
#include <vector>

#include "bench/kernels/stages.hpp"

namespace burnish::bench {
namespace {

struct Grid {
    static constexpr int kCount = 4096;
    AlignedVector<float> x, y, z;
    AlignedVector<ScreenVertex> screen{kCount};
    AlignedVector<HomogeneousVertex> homogeneous{kCount};

    Grid() {
        Random random(1);
        for (AlignedVector<float>* v : {&x, &y, &z})
            for (int i = 0; i < kCount; ++i) v->push_back(random.real(-1.0F, 1.0F));
    }
    TransformCtx context() {
        // 60 degrees, 3 units away, 1024 x 768, 1/16 pixel.
        return {x.data(),
                y.data(),
                z.data(),
                kCount,
                {1.3F, 0, 0, 0, 0, 1.73F, 0, 0, 0, 0, -1.02F, -1, 0, 0, 2.86F, 3},
                {512, 384, 1024, 768, 16, 0.5F},
                screen.data(),
                homogeneous.data()};
    }
};

/// Vertices with a half vector and a cosine each, as two-combiner machines want them.
struct LitVertices {
    static constexpr int kCount = 1024;
    static constexpr std::array<std::int8_t, 4> kValues{
        VertexValue::half, VertexValue::half + 1, VertexValue::half + 2, VertexValue::n_dot_l};
    std::vector<float> frames = std::vector<float>(kCount * LightVerticesCtx::kFrameFloats);
    std::vector<float> out = std::vector<float>(kCount * kValues.size());

    LitVertices() {
        for (std::size_t i = 0; i < frames.size(); ++i)
            frames[i] = 0.25F + 0.5F * static_cast<float>(i * 7 % 31) / 31.0F;
    }
    LightVerticesCtx context() {
        LightVerticesCtx ctx{};
        ctx.frames = frames.data();
        ctx.count = kCount;
        ctx.light[1] = ctx.eye[2] = 3.0F;
        ctx.eye_w = 1.0F;
        ctx.values = kValues.data();
        ctx.stride = static_cast<int>(kValues.size());
        ctx.out = out.data();
        return ctx;
    }
};

}  // namespace

void add_transform() {
    static Grid grid;
    static Grid reference;
    add(
        "transform", Grid::kCount,
        [](const KernelTable& table) -> std::string {
            table.transform(grid.context());
            table_reference().transform(reference.context());
            const auto bytes = sizeof(ScreenVertex) * Grid::kCount;
            const bool same = std::memcmp(grid.screen.data(), reference.screen.data(), bytes) == 0;
            return same ? "" : "screen vertices";
        },
        [](const KernelTable& table, benchmark::State& state) {
            const TransformCtx ctx = grid.context();
            for (auto _ : state) {
                table.transform(ctx);
                benchmark::ClobberMemory();
            }
        });
}

void add_light_vertices() {
    static LitVertices vertices, reference;
    add(
        "light_vertices", LitVertices::kCount,
        [](const KernelTable& table) -> std::string {
            table.light_vertices(vertices.context());
            table_reference().light_vertices(reference.context());
            return vertices.out == reference.out ? "" : "values of vertices";
        },
        [](const KernelTable& table, benchmark::State& state) {
            const LightVerticesCtx ctx = vertices.context();
            for (auto _ : state) {
                table.light_vertices(ctx);
                benchmark::ClobberMemory();
            }
        });
}

}  // namespace burnish::bench
