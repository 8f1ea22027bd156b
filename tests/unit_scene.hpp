#pragma once

#include <array>
#include <burnish/error.hpp>
#include <burnish/scene.hpp>
#include <initializer_list>
#include <memory>
#include <vector>

#include "kernel_packet.hpp"
#include "machine/unit_operations.hpp"

/// Random texture shaders on random textures, drawn with coordinates of its own for every pixel.
namespace burnish {

using Op = TextureOperation;

/// Formats that an operation reads from its previous unit.
inline std::vector<TexelFormat> readable_formats(Op op, BumpSource bump) {
    using F = TexelFormat;
    const bool offset = op >= Op::offset_2d && op <= Op::offset_projective_rectangle_scale;
    if (offset && bump == BumpSource::dsdt) {
        if (is_dimmed(op)) return {F::dsdt8_mag8, F::dsdt8_mag8_intensity8};
        return {F::dsdt8, F::dsdt8_mag8, F::dsdt8_mag8_intensity8};
    }
    if (is_hilo_offset(op)) return {F::signed_hilo16, F::signed_hilo8};
    if (op == Op::dependent_hilo) return {F::hilo16, F::hilo8};
    if (op == Op::texture_brdf) return {F::hilo16, F::signed_hilo16};
    if (takes_dot_product(op))
        return {F::rgba8, F::signed_rgba8, F::hilo16, F::signed_hilo16, F::rgba8};
    return {F::rgba8};
}

inline TextureUnit random_parameters(Random& random, Op op, int previous, int mappings) {
    TextureUnit u{.operation = op, .previous = previous};
    u.dot_mapping = static_cast<DotMapping>(random.below(mappings));
    for (int k = 0; k < 4; ++k) u.offset_matrix[k / 2][k % 2] = random.real(-1.0F, 1.0F);
    u.offset_scale = random.real(-2.0F, 2.0F);
    u.offset_bias = random.real(-0.5F, 1.0F);
    for (int c = 0; c < 3; ++c) u.const_eye[c] = random.real(-1.0F, 1.0F);
    for (CullTest& test : u.cull) test = static_cast<CullTest>(random.below(2));
    return u;
}

/// A chain of an operation and what it needs, from unit 0 on; the rest is filled at random.
inline TextureShader random_shader(Random& random, const Machine& machine) {
    const bool nine_bit = machine.numbers == NumberModel::nine_bit;
    const int mappings = nine_bit ? 10 : 3;
    TextureShader shader;
    if (nine_bit && random.chance(3)) shader.bump_source = BumpSource::rgba8;
    const auto op = static_cast<Op>(random.below(kTextureOperationCount));
    const int dots = dot_products_used(op);
    const auto plain = [&] {
        constexpr std::array kPlain{Op::texture_2d, Op::texture_rectangle, Op::texture_cube_map,
                                    Op::texture_1d, Op::texture_3d};
        return random.chance(3) ? random.pick(kPlain) : Op::texture_2d;
    };
    for (TextureUnit& u : shader.units) u = random_parameters(random, plain(), 0, mappings);
    int at = 1;
    if (op == Op::texture_brdf) at = 2;
    if (dots > 1) {
        for (int k = 1; k < dots; ++k)
            shader.units.at(static_cast<std::size_t>(at++)).operation = Op::dot_product;
        if (is_reflection(op) && random.chance(2))
            shader.units[2].operation = Op::dot_product_diffuse_cube_map;
    }
    shader.units.at(static_cast<std::size_t>(at)).operation = op;
    if (op == Op::dot_product_diffuse_cube_map)
        shader.units.at(static_cast<std::size_t>(++at)).operation =
            Op::dot_product_reflect_cube_map;
    // What is left over reads one of the units before, or does as it likes.
    for (int i = at + 1; i < kTextureShaderUnits; ++i) {
        TextureUnit& u = shader.units.at(static_cast<std::size_t>(i));
        constexpr std::array kMore{Op::dependent_ar,
                                   Op::dependent_gb,
                                   Op::offset_2d,
                                   Op::cull_fragment,
                                   Op::pass_through,
                                   Op::offset_2d_scale,
                                   Op::dot_product_pass_through};
        u.operation = random.pick(kMore);
        u.previous = random.below(i);
    }
    return shader;
}

inline TexturePtr random_unit_texture(Random& random, TextureTarget target, TexelFormat format) {
    const bool one_d = target == TextureTarget::one_d, cube = target == TextureTarget::cube;
    const int width = random.between(1, 9);
    const int height = one_d ? 1 : cube ? width : random.between(1, 9);
    const int depth = target == TextureTarget::three_d ? random.between(1, 4) : 1;
    const bool clamps = target == TextureTarget::rectangle;
    const auto wrap = [&] {
        return !clamps && random.chance(2) ? Wrap::repeat : Wrap::clamp_to_edge;
    };
    TextureDescription description{.target = target, .format = format};
    description.sampler = {Filter::nearest, wrap(), wrap(), wrap()};
    description.depth = depth;
    std::vector<Image8> images(static_cast<std::size_t>(cube ? 6 : depth), Image8(width, height));
    for (Image8& image : images) {
        for (std::uint8_t& byte : image.rgba) byte = static_cast<std::uint8_t>(random.below(256));
    }
    return std::make_shared<const Texture>(images, description);
}

/// Textures that the units of a shader can use, but for one in ten.
inline std::vector<TexturePtr> random_unit_textures(Random& random, const TextureShader& shader) {
    std::vector<TexturePtr> textures;
    for (int i = 0; i < kTextureShaderUnits; ++i) {
        const Op op = shader.units.at(static_cast<std::size_t>(i)).operation;
        TextureTarget target = sampled_target(op).value_or(TextureTarget::two_d);
        std::vector<TexelFormat> formats{TexelFormat::rgba8, TexelFormat::signed_rgba8,
                                         TexelFormat::signed_rgb8_unsigned_alpha8,
                                         TexelFormat::dsdt8_mag8_intensity8};
        for (int k = i + 1; k < kTextureShaderUnits; ++k) {
            const TextureUnit& reader = shader.units.at(static_cast<std::size_t>(k));
            const bool brdf = reader.operation == Op::texture_brdf && k - i <= 2;
            if (brdf || (reads_previous(reader.operation) && reader.previous == i)) {
                formats = readable_formats(reader.operation, shader.bump_source);
                break;
            }
        }
        if (random.chance(30)) target = TextureTarget::rectangle;
        TexturePtr texture = random_unit_texture(random, target, random.pick(formats));
        textures.push_back(random.chance(30) ? nullptr : texture);
    }
    return textures;
}

/// The fetch between stages that reads a texture.
inline FetchTarget table_for(TextureTarget target) {
    switch (target) {
        case TextureTarget::one_d:
            return FetchTarget::table_1d;
        case TextureTarget::two_d:
            return FetchTarget::table_2d;
        case TextureTarget::rectangle:
            return FetchTarget::table_rectangle;
        case TextureTarget::cube:
            return FetchTarget::table_cube_map;
        case TextureTarget::three_d:
            break;
    }
    return FetchTarget::table_3d;
}

inline std::array<glm::vec4, 4> random_coordinates(Random& random) {
    std::array<glm::vec4, 4> sets{};
    for (glm::vec4& uv : sets)
        uv = {random.real(-1.5F, 1.5F), random.real(-1.5F, 1.5F), random.real(-1.5F, 1.5F),
              random.chance(3) ? random.real(0.5F, 2.0F) : 1.0F};
    return sets;
}

/// A frame of single pixels, each a quad with coordinates that are the same all over it.
struct UnitScene {
    static constexpr int kSide = 16;

    UnitScene(Random& random, const Machine& machine) {
        do {  // e.g. the depth replaced twice
            program.texture_shader = random_shader(random, machine);
        } while (!valid(*program.texture_shader, machine));
        program.units = random_unit_textures(random, *program.texture_shader);
        scene.width = scene.height = kSide;
        scene.machine = machine;
        scene.format = PixelFormat::rgba32f;
        scene.background = glm::vec4(0.75F);
        RawVertices raw{.space = Space::window, .topology = Topology::quads, .vertices = {}};
        for (int y = 0; y < kSide; ++y) {
            for (int x = 0; x < kSide; ++x) {
                coordinates.push_back(random_coordinates(random));
                for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
                    raw.vertices.push_back(
                        {.position = {x + dx, y + dy, 0.5F, 1.0F}, .uv = coordinates.back()});
            }
        }
        geometry = std::move(raw);
        use(program.combiners);
    }

    void use(const CombinerProgram& combiners) {
        program.combiners = combiners;
        auto material = std::make_shared<Material>();
        material->program = program;
        scene.objects.assign(1, {geometry, material, glm::mat4(1.0F), {}});
        scene.objects[0].raster.depth_test = DepthTest::always;
    }

    Scene scene;
    ProgramMaterial program;
    RawVertices geometry;
    std::vector<std::array<glm::vec4, 4>> coordinates;  ///< row by row

  private:
    static bool valid(const TextureShader& shader, const Machine& machine) {
        try {
            shader.validate(machine);
        } catch (const Error&) {
            return false;
        }
        return true;
    }
};

}  // namespace burnish
