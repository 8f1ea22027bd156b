#include "shade/corners.hpp"

#include <burnish/error.hpp>
#include <cstdint>
#include <utility>
#include <variant>

#include "shade/shading.hpp"

namespace burnish {

namespace {

/// Addresses of texels at corners look for their level in `plane`.
void set_level_plane(std::vector<InputOp>& ops, int plane) {
    for (InputOp& op : ops) {
        auto* const address = std::get_if<LevelAddressCtx>(&op);
        if (address != nullptr && address->lambda == SampledCorners::kLevel)
            address->lambda = plane;
    }
}

void set_level_plane(LightShading& light, int plane) {
    for (EarlierPass& pass : light.earlier_passes) set_level_plane(pass.inputs, plane);
    set_level_plane(light.inputs, plane);
}

}  // namespace

void plan_corners(Shading& shading) {
    if (shading.depth_attribute >= 0) {
        throw Error(ErrorCode::bad_program,
                    "a texture shader that replaces depths, which nothing filters, on a machine "
                    "with filter_order = after, expected before");
    }
    int planes = shading.program.plane_count;
    const auto take = [&](int count) { return std::exchange(planes, planes + count); };
    CornerShading& corners = *shading.corners;
    const NumberModel numbers = shading.program.numbers;
    SamplePlan sampling{numbers, kSampleScratch, take(kSamplePlanes)};
    const int weight = take(2), level = take(1);
    corners.corner = plan_texel_corner(corners.map, weight, level, sampling, corners.level);
    set_level_plane(shading, level);
    for (FurtherLight& light : shading.further_lights) set_level_plane(light, level);
    corners.colors = shading.result;
    corners.filter = {take(4 * FilterCtx::kCorners), weight, take(4)};
    const int out = corners.filter.out;
    const std::uint8_t any_words = numbers == NumberModel::wide ? 1 : 0;
    corners.blend = {out, take(4), out, 4, corners.corner.lambda, 0, any_words};
    for (int c = 0; c < 4; ++c)
        shading.result[static_cast<std::size_t>(c)] = static_cast<std::int16_t>(out + c);
    shading.program.plane_count = planes;
}

}  // namespace burnish
