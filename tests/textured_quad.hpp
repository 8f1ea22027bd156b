#pragma once

#include <array>
#include <burnish/renderer.hpp>
#include <burnish/scene.hpp>
#include <memory>
#include <utility>
#include <vector>

/// One quad in window coordinates that shows a texture as it reaches its register.
namespace burnish {

using Bytes = std::array<int, 4>;

/// An image of one colour.
inline Image8 plain_image(int width, int height, const Bytes& rgba) {
    Image8 image(width, height);
    for (std::size_t i = 0; i < image.rgba.size(); ++i)
        image.rgba[i] = static_cast<std::uint8_t>(rgba[i % 4]);
    return image;
}

/// A grey row.
inline Image8 row_image(const std::vector<int>& greys) {
    Image8 image(static_cast<int>(greys.size()), 1);
    for (int x = 0; x < image.width; ++x) {
        for (int c = 0; c < 3; ++c)
            image.at(x, 0)[c] = static_cast<std::uint8_t>(greys[static_cast<std::size_t>(x)]);
        image.at(x, 0)[3] = 255;
    }
    return image;
}

inline TexturePtr make_texture(const std::vector<Image8>& images, TextureDescription description) {
    return std::make_shared<const Texture>(std::span<const Image8>(images), description);
}

inline Sampler filtered(Filter filter, float lod_bias = 0.0F) {
    Sampler sampler;
    sampler.filter = filter;
    sampler.lod_bias = lod_bias;
    return sampler;
}

/// (s, t, r, q) of the upper left, upper right, lower right and lower left corner.
using Corners = std::array<glm::vec4, 4>;

/// s from `left` to `right` and t from `top` to `bottom`.
inline Corners flat(float left, float right, float top = 0.0F, float bottom = 1.0F) {
    return {{{left, top, 0.0F, 1.0F},
             {right, top, 0.0F, 1.0F},
             {right, bottom, 0.0F, 1.0F},
             {left, bottom, 0.0F, 1.0F}}};
}
/// The same coordinates at every corner.
inline Corners everywhere(const glm::vec4& strq) {
    return {strq, strq, strq, strq};
}

/// A frame of width x height pixels that a quad covers: result = max(0, tex0), or max(0, -tex0).
inline Scene textured_scene(TexturePtr texture, int width, int height, const Corners& corners,
                            const char* machine = "nv2a", bool negated = false) {
    using namespace combine;
    ProgramBuilder p;
    const Input texel = negated ? Input{tex(0), Mapping::signed_negate} : in(tex(0));
    p.stage().rgb().ab(mul(texel, one()), Register::spare0);
    p.alpha().ab(mul(alpha(texel), alpha(one())), Register::spare0);
    p.lerp(raw(Register::zero), raw(Register::zero), raw(Register::spare0), raw(Register::zero));
    p.out_alpha(alpha(raw(Register::spare0)));
    auto material = std::make_shared<Material>();
    material->program.emplace();
    material->program->combiners = p.build();
    material->program->units = {std::move(texture)};
    RawVertices quad{Space::window, Topology::quads, {}};
    const auto w = static_cast<float>(width), h = static_cast<float>(height);
    const std::array<glm::vec2, 4> places{{{0.0F, 0.0F}, {w, 0.0F}, {w, h}, {0.0F, h}}};
    for (std::size_t i = 0; i < 4; ++i) {
        RawVertex v;
        v.position = {places[i].x, places[i].y, 0.5F, 1.0F};
        v.uv[0] = corners[i];
        quad.vertices.push_back(v);
    }
    Scene scene;
    scene.width = width;
    scene.height = height;
    scene.machine = machine_profile(machine);
    scene.objects.push_back(
        {std::move(quad), std::move(material), glm::mat4(1.0F), {DepthTest::always, true, {}}});
    return scene;
}

inline Bytes bytes_at(const Framebuffer& frame, int x, int y) {
    const std::byte* at = frame.row(y) + static_cast<std::ptrdiff_t>(x) * 4;
    return {std::to_integer<int>(at[0]), std::to_integer<int>(at[1]), std::to_integer<int>(at[2]),
            std::to_integer<int>(at[3])};
}

inline Framebuffer draw(const Scene& scene) {
    Framebuffer frame(scene.width, scene.height);
    Renderer().render(scene, frame);
    return frame;
}

/// The red of every pixel of a row.
inline std::vector<int> reds(const Framebuffer& frame, int y = 0) {
    std::vector<int> row;
    for (int x = 0; x < frame.width(); ++x) row.push_back(bytes_at(frame, x, y)[0]);
    return row;
}

/// One pixel with the texture at (s, t, r, q).
inline Bytes sampled(const TexturePtr& texture, const glm::vec4& strq,
                     const char* machine = "nv2a") {
    return bytes_at(draw(textured_scene(texture, 1, 1, everywhere(strq), machine)), 0, 0);
}

/// The same with signed codes of nv2a: -255 .. 255.
inline Bytes sampled_signed(const TexturePtr& texture, const glm::vec4& strq) {
    const Corners corners = everywhere(strq);
    const Bytes up = bytes_at(draw(textured_scene(texture, 1, 1, corners)), 0, 0);
    const Bytes down = bytes_at(draw(textured_scene(texture, 1, 1, corners, "nv2a", true)), 0, 0);
    return {up[0] - down[0], up[1] - down[1], up[2] - down[2], up[3] - down[3]};
}

}  // namespace burnish
