#pragma once

#include <burnish/renderer.hpp>
#include <burnish/shapes.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

/// Named scenes whose pictures are pinned. Their maps come from here, not from the default
/// material, which may become more beautiful.
namespace burnish::scenes {

/// One texel of noise, 0 .. 255, the same on every machine.
inline std::uint8_t noise(std::uint32_t x, std::uint32_t y, std::uint32_t channel) {
    std::uint32_t h = x * 0x9e3779b1U ^ y * 0x85ebca77U ^ channel * 0xc2b2ae3dU;
    h = (h ^ h >> 15) * 0x2c1b3c6dU;
    h = (h ^ h >> 12) * 0x297a2d39U;
    return static_cast<std::uint8_t>(h >> 24);
}

/// A map around `base` that varies by `spread` along v and little along u, as brush marks do.
inline TexturePtr streaks(int width, int height, std::array<int, 4> base, int spread,
                          const Sampler& sampler = {}) {
    Image8 image(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (int c = 0; c < 4; ++c) {
                const auto column = static_cast<std::uint32_t>(x / 16);
                const int offset =
                    noise(column, static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(c)) *
                    spread / 255;
                const int value = base[static_cast<std::size_t>(c)] + offset - spread / 2;
                image.at(x, y)[c] = static_cast<std::uint8_t>(value < 0     ? 0
                                                              : value > 255 ? 255
                                                                            : value);
            }
        }
    }
    return std::make_shared<Texture>(image, sampler);
}

/// Maps of t / alpha_x and b / alpha_y at a quarter of their length, and a tinted ks.
inline std::shared_ptr<Material> brushed() {
    auto material = std::make_shared<Material>();
    material->name = "test-brushed";
    material->kd = {0.20F, 0.19F, 0.18F};
    material->ks = {0.9F, 0.9F, 0.9F};
    material->map_scale = 0.25F;
    material->tangent_map = streaks(96, 64, {240, 128, 128, 220}, 24);
    material->bitangent_map = streaks(96, 64, {128, 180, 140, 255}, 60);
    material->specular_map = streaks(96, 64, {220, 210, 190, 255}, 60);
    return material;
}

inline Scene lit_scene(const Machine& machine, int width, int height) {
    Scene scene;
    scene.width = width;
    scene.height = height;
    scene.machine = machine;
    scene.ambient = {0.05F, 0.05F, 0.06F};
    const float grey = 46.0F / 255.0F;  // a code of every format
    scene.background = {grey, grey, grey, 1.0F};
    scene.lights.push_back({.position = {-0.4F, 0.8F, 0.9F}, .color = {1.0F, 0.95F, 0.9F}});
    return scene;
}

inline Scene knot() {
    Scene scene = lit_scene(machine_profile("ideal"), 320, 240);
    scene.camera.position = {0.6F, 0.5F, 3.6F};
    scene.objects.push_back({Mesh(shapes::torus_knot(200, 24)), brushed(), glm::mat4(1.0F), {}});
    return scene;
}

inline Scene ellipsoid() {
    Machine machine = machine_profile("geforce256");
    machine.texture_units = 3;
    Scene scene = lit_scene(machine, 320, 240);
    scene.lights[0].color = glm::vec3(1.0F);
    scene.objects.push_back(
        {Mesh(shapes::sphere(64, 32, {1.4F, 1.0F, 1.0F})), brushed(), glm::mat4(1.0F), {}});
    return scene;
}

/// One million triangles, most of them smaller than a pixel.
inline Scene million() {
    Scene scene = lit_scene(machine_profile("nv2a"), 512, 512);
    scene.lights[0].color = glm::vec3(1.0F);
    scene.objects.push_back({Mesh(shapes::sphere(1000, 501)), brushed(), glm::mat4(1.0F), {}});
    return scene;
}

/// A strongly coloured map times n.l, and a little of it without.
inline std::shared_ptr<Material> painted(std::array<int, 4> base) {
    using namespace combine;
    ProgramBuilder p;
    p.constants({0.3F, 0.3F, 0.3F, 0.0F}, {});
    p.stage()
        .rgb()
        .ab(mul(in(tex(0)), alpha(in(Register::col0))))
        .cd(mul(in(tex(0)), in(Register::const0)))
        .sum(Register::spare0);
    p.lerp(raw(Register::zero), raw(Register::zero), raw(Register::spare0), raw(Register::zero));
    p.out_alpha(alpha(one()));
    auto material = std::make_shared<Material>();
    material->name = "test-painted";
    material->program = ProgramMaterial{};
    material->program->combiners = p.build();
    material->program->units = {streaks(96, 64, base, 150)};
    material->program->col0_rgb = ColorInput::half_tangent;
    material->program->col0_a = ColorInput::n_dot_l;
    return material;
}

/// A floor that passes under the camera and behind it, a ball cut by the near plane, and a wall so
/// close to the eye and so wide that its far corners leave the guard band.
inline Scene near_plane() {
    Scene scene = lit_scene(machine_profile("ideal"), 300, 200);
    scene.lights[0].position = {0.5F, 0.6F, 0.9F};
    scene.camera.position = {0.0F, 0.6F, 1.0F};
    scene.camera.focal_point = {0.0F, 0.3F, -3.0F};
    scene.camera.near = 0.05F;
    const auto tiled = [](MeshData data, float times) {
        for (glm::vec2& uv : data.uvs) uv *= times;
        return Mesh(data);
    };
    scene.objects.push_back({tiled(shapes::plane(7, 5), 3.0F),
                             painted({210, 150, 90, 255}),
                             placement({0.0F, -0.2F, 0.0F}, {1.0F, 0.0F, 0.0F}, -90.0F, 60.0F),
                             {}});
    scene.objects.push_back({Mesh(shapes::sphere(24, 12)),
                             painted({110, 200, 140, 255}),
                             placement({-0.11F, 0.52F, 0.88F}, {0.0F, 1.0F, 0.0F}, 20.0F, 0.09F),
                             {}});
    scene.objects.push_back({tiled(shapes::plane(3, 3), 40.0F),
                             painted({120, 140, 220, 255}),
                             placement({150.1F, 100.5F, 0.4F}, {0.0F, 1.0F, 0.0F}, -0.05F, 300.0F),
                             {.depth_test = DepthTest::lequal}});
    return scene;
}

/// Program with both portions, dot, mux, expand, half bias, scale, bias, colour sum and E*F.
inline CombinerProgram busy_program() {
    using namespace combine;
    ProgramBuilder p;
    p.constants({0.25F, 0.5F, 0.75F, 0.3F}, {0.9F, 0.2F, 0.4F, 0.6F});
    p.stage()
        .rgb()
        .ab(dot(expand(Register::col0), expand(tex(0))), Register::spare1)
        .cd(mul(half_bias(Register::col0), invert(Register::const0)), tex(1))
        .scale(Scale::two);
    p.alpha()
        .ab(mul(alpha(in(Register::col0)), alpha(one())), Register::spare0)
        .cd(mul(alpha(in(tex(0))), blue(in(Register::const1))), Register::spare1);
    p.stage()
        .rgb()
        .ab(mul(in(Register::spare1), in(Register::const1)))
        .cd(mul(in(tex(0)), one()))
        .mux(Register::spare1);
    p.stage()
        .rgb()
        .ab(mul(in(Register::spare1), one()))
        .cd(mul(in(tex(1)), one()))
        .sum(Register::spare0)
        .bias();
    p.product(raw(Register::col1), raw(tex(0)));
    p.lerp(alpha(raw(Register::spare1)), raw(Register::color_sum), raw(Register::final_product),
           raw(Register::const0));
    p.out_alpha(blue(raw(Register::spare1)));
    return p.build();
}

inline RawVertex corner(glm::vec4 position, glm::vec4 color, glm::vec2 uv) {
    RawVertex v;
    v.position = position;
    v.color0 = color;
    v.color1 = {color.b, color.r, color.g, 1.0F};
    v.uv[0] = {uv.x, uv.y, 0.0F, 1.0F};
    return v;
}

/// Raw vertices in all three spaces, every primitive, several depth tests.
inline Scene machine() {
    Scene scene = lit_scene(machine_profile("nv2a"), 200, 150);
    scene.lights.clear();
    auto material = std::make_shared<Material>();
    material->program.emplace();
    material->program->combiners = busy_program();
    material->program->units = {streaks(16, 12, {128, 128, 128, 128}, 250,
                                        {Filter::linear, Wrap::clamp_to_edge, Wrap::repeat})};
    const auto add = [&](Space space, Topology topology, std::vector<RawVertex> vertices,
                         RasterState raster) {
        scene.objects.push_back(
            {RawVertices{space, topology, std::move(vertices)}, material, glm::mat4(1.0F), raster});
    };
    const glm::vec4 red(1.0F, 0.2F, 0.1F, 0.2F), green(0.1F, 0.9F, 0.2F, 0.9F),
        blue(0.2F, 0.1F, 1.0F, 0.7F), white(1.0F);
    add(Space::window, Topology::quads,
        {corner({10.0F, 10.0F, 0.5F, 1.0F}, red, {0.0F, 0.0F}),
         corner({110.0F, 12.0F, 0.5F, 2.0F}, green, {1.5F, 0.0F}),
         corner({100.0F, 90.0F, 0.5F, 4.0F}, blue, {1.5F, 2.0F}),
         corner({16.25F, 80.0F, 0.5F, 1.0F}, white, {0.0F, 2.0F})},
        {.depth_test = DepthTest::always});
    add(Space::clip, Topology::triangle_strip,
        {corner({-0.4F, -0.9F, 0.1F, 1.0F}, blue, {0.0F, 0.0F}),
         corner({0.9F, -0.8F, -0.3F, 1.0F}, red, {1.0F, 0.0F}),
         corner({-0.2F, 0.7F, 0.2F, 1.5F}, green, {0.0F, 1.0F}),
         corner({1.2F, 0.9F, 0.4F, 1.2F}, white, {1.0F, 1.0F})},
        {.depth_test = DepthTest::lequal});
    add(Space::object, Topology::triangle_fan,
        {corner({0.0F, 0.0F, 0.2F, 1.0F}, white, {0.5F, 0.5F}),
         corner({1.0F, 0.1F, 0.0F, 1.0F}, red, {1.0F, 0.5F}),
         corner({0.2F, 0.9F, 0.4F, 1.0F}, green, {0.5F, 1.0F}),
         corner({-0.8F, 0.2F, 0.1F, 1.0F}, blue, {0.0F, 0.5F}),
         corner({-0.1F, -0.7F, 0.0F, 1.0F}, red, {0.5F, 0.0F})},
        {.depth_test = DepthTest::gequal, .depth_write = false});
    add(Space::window, Topology::quad_strip,
        {corner({120.0F, 20.0F, 0.2F, 1.0F}, red, {0.0F, 0.0F}),
         corner({190.0F, 20.0F, 0.2F, 1.0F}, green, {1.0F, 0.0F}),
         corner({125.0F, 60.0F, 0.7F, 1.0F}, blue, {0.0F, 0.5F}),
         corner({180.0F, 70.0F, 0.7F, 1.0F}, white, {1.0F, 0.5F}),
         corner({120.0F, 140.0F, 0.3F, 1.0F}, green, {0.0F, 1.0F}),
         corner({195.0F, 130.0F, 0.3F, 1.0F}, red, {1.0F, 1.0F})},
        {.depth_test = DepthTest::notequal, .cull = Cull::none});
    return scene;
}

/// Glass, smoke and lattices: blended layers of meshes and of raw vertices between opaque ones,
/// before and after them, and alpha tests with holes.
inline Scene layers() {
    Scene scene = lit_scene(machine_profile("nv2a"), 260, 190);
    scene.camera.position = {0.4F, 0.5F, 3.4F};
    const auto material = [](std::array<int, 4> base, AlphaTest test) {
        auto made = painted(base);
        made->program->combiners.final_combiner.g = {Register::tex0, Mapping::unsigned_identity,
                                                     Component::alpha};
        made->alpha_test = test;
        return made;
    };
    const auto sheet = [&](glm::vec2 from, float size, float depth, glm::vec4 color,
                           const Blend& blend) {
        const glm::vec4 other(color.g, color.b, color.r, color.a * 0.5F);
        const auto at = [&](float x, float y) {
            return glm::vec4(from.x + x * size, from.y + y * size, depth, 1.0F);
        };
        const auto see = [](const glm::vec4& p, const glm::vec4& c) {
            RawVertex v;
            v.position = p;
            v.color0 = c;
            return v;
        };
        auto plain = std::make_shared<Material>();
        const Input color0 = combine::raw(Register::col0);
        ProgramBuilder p;
        p.lerp(color0, combine::one(), combine::raw(Register::zero), combine::raw(Register::zero));
        p.out_alpha(combine::alpha(color0));
        plain->program.emplace();
        plain->program->combiners = p.build();
        scene.objects.push_back(
            {RawVertices{Space::window,
                         Topology::quads,
                         {see(at(0.0F, 0.0F), color), see(at(1.0F, 0.1F), other),
                          see(at(0.9F, 1.0F), color), see(at(-0.1F, 0.8F), other)}},
             plain,
             glm::mat4(1.0F),
             {.depth_test = DepthTest::lequal, .depth_write = false, .blend = blend}});
    };
    const glm::vec3 y(0.0F, 1.0F, 0.0F);
    scene.objects.push_back({Mesh(shapes::torus_knot(120, 14)),
                             painted({170, 120, 90, 255}),
                             placement({-0.5F, 0.2F, -0.6F}, y, 20.0F, 0.8F),
                             {}});
    scene.objects.push_back({Mesh(shapes::sphere(48, 24)),
                             material({120, 160, 130, 128}, {Comparison::gequal, 0.5F}),
                             placement({0.8F, 0.1F, 0.2F}, y, 70.0F, 0.8F),
                             {}});
    for (int i = 0; i < 6; ++i) {
        const auto k = static_cast<float>(i);
        sheet({10.0F + 22.0F * k, 8.0F + 14.0F * k}, 90.0F, 0.99F - 0.001F * k,
              {0.9F - 0.1F * k, 0.2F + 0.1F * k, 0.3F, 0.3F + 0.1F * k}, Blend::alpha());
    }
    scene.objects.push_back({Mesh(shapes::torus_knot(90, 10)),
                             material({90, 130, 170, 128}, {}),
                             placement({0.3F, -0.3F, 0.6F}, y, 120.0F, 0.5F),
                             {.depth_write = false, .blend = Blend::alpha()}});
    scene.objects.push_back({Mesh(shapes::sphere(24, 12)),
                             painted({200, 90, 90, 255}),
                             placement({-0.9F, -0.5F, 0.7F}, y, 0.0F, 0.3F),
                             {}});
    sheet({120.0F, 20.0F}, 110.0F, 0.2F, {0.4F, 0.3F, 0.1F, 0.5F}, Blend::add());
    sheet({30.0F, 100.0F}, 80.0F, 0.2F, {0.3F, 0.1F, 0.2F, 0.5F},
          {BlendFactor::one, BlendFactor::one, BlendEquation::reverse_subtract, {}});
    sheet({170.0F, 110.0F}, 70.0F, 0.2F, {0.7F, 0.8F, 0.9F, 0.5F}, Blend::multiply());
    scene.objects.push_back({Mesh(shapes::sphere(30, 20)),
                             material({140, 140, 200, 128}, {Comparison::less, 0.6F}),
                             placement({-0.1F, 0.6F, 1.0F}, y, 10.0F, 0.4F),
                             {.depth_test = DepthTest::lequal, .blend = Blend::premultiplied()}});
    return scene;
}

/// Squares of the half vector's components over a map in n.l: what every light and every axis of
/// the frame have a part in.
inline std::shared_ptr<Material> half_vector_colors() {
    using namespace combine;
    ProgramBuilder p;
    p.stage()
        .rgb()
        .ab(mul(in(tex(0)), alpha(in(Register::col0))))
        .cd(mul(expand(Register::col0), expand(Register::col0)))
        .sum(Register::spare0)
        .scale(Scale::half);
    p.lerp(raw(Register::zero), raw(Register::zero), raw(Register::spare0), raw(Register::zero));
    p.out_alpha(alpha(one()));
    auto material = painted({200, 150, 110, 255});
    material->program->combiners = p.build();
    return material;
}

/// A knot of few sides with mirrored uv on its far half and a ball, in a directional and a point
/// light; frames orthonormal at the pixel.
inline Scene two_lights() {
    Scene scene = lit_scene(machine_profile("ideal"), 240, 160);
    scene.machine.tangent_frames = TangentFrames::orthonormal;
    scene.camera.position = {0.3F, 0.6F, 3.4F};
    scene.lights.push_back(
        {.position = {1.4F, -0.3F, 1.1F}, .position_w = 1.0F, .color = {0.7F, 0.8F, 1.0F}});
    MeshData knot = shapes::torus_knot(60, 7);
    for (std::size_t i = knot.uvs.size() / 2; i < knot.uvs.size(); ++i) {
        knot.uvs[i].x = -knot.uvs[i].x;
        knot.tangents[i] = -knot.tangents[i];
    }
    const auto material = half_vector_colors();
    const glm::vec3 y(0.0F, 1.0F, 0.0F);
    scene.objects.push_back(
        {Mesh(knot), material, placement({-0.6F, 0.0F, 0.0F}, y, 15.0F, 0.8F), {}});
    scene.objects.push_back({Mesh(shapes::sphere(14, 8)),
                             material,
                             placement({1.0F, 0.1F, 0.0F}, y, -30.0F, 0.7F),
                             {}});
    return scene;
}

/// Filtering after combining: a floor with mip levels, blended where it lies between two, and a
/// ball with the maps of a model, texels larger than pixels.
inline Scene filtered_after() {
    Scene scene = lit_scene(machine_profile("nv2a"), 160, 120);
    scene.machine.filter_order = FilterOrder::after;
    scene.camera.position = {0.0F, 0.6F, 1.0F};
    scene.camera.focal_point = {0.0F, 0.2F, -3.0F};
    const TexturePtr flat = streaks(96, 64, {210, 150, 90, 255}, 150);
    Image8 texels(96, 64);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x)
            for (int c = 0; c < 4; ++c)
                texels.at(x, y)[c] = static_cast<std::uint8_t>(flat->texel(0, 0, x, y, c));
    auto floor = painted({0, 0, 0, 0});
    floor->program->units = {std::make_shared<Texture>(
        std::span<const Image8>(&texels, 1),
        TextureDescription{.sampler = {Filter::linear_mipmap_linear}, .box_mipmaps = true})};
    MeshData tiled = shapes::plane(7, 5);
    for (glm::vec2& uv : tiled.uvs) uv *= 3.0F;
    scene.objects.push_back({Mesh(tiled),
                             floor,
                             placement({0.0F, -0.2F, 0.0F}, {1.0F, 0.0F, 0.0F}, -90.0F, 20.0F),
                             {}});
    scene.objects.push_back({Mesh(shapes::sphere(24, 12)),
                             brushed(),
                             placement({0.1F, 0.3F, -0.6F}, {0.0F, 1.0F, 0.0F}, 20.0F, 0.5F),
                             {}});
    return scene;
}

struct NamedScene {
    std::string name;
    Scene (*make)();
};
inline const std::vector<NamedScene>& all() {
    static const std::vector<NamedScene> list{{"knot", knot},
                                              {"ellipsoid", ellipsoid},
                                              {"million", million},
                                              {"near_plane", near_plane},
                                              {"machine", machine},
                                              {"layers", layers},
                                              {"two_lights", two_lights},
                                              {"filtered_after", filtered_after}};
    return list;
}

}  // namespace burnish::scenes
