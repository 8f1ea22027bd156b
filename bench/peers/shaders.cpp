#include "bench/peers/shaders.hpp"

namespace burnish::peers {

namespace {

// Bytes n of maps of vectors stand for (n - 128) / 127.5 = 2 texel - 256/255.
constexpr const char* kHeader = R"(#version 450 core
layout(std140, binding = 0) uniform Frame {
    mat4 clip_from_object;
    vec4 eye, light, intensity, numbers, lit_tint, lit_base, flat_color;
};
#define REACH numbers.x
#define EXPONENT_LOW numbers.y
#define EXPONENT_HIGH numbers.z
#define SPECULAR_SCALE numbers.w
const float kZero = 128.0 / 255.0;
#ifdef VULKAN
#define UNIT(n) layout(set = 1, binding = n)
#else
#define UNIT(n) layout(binding = n)
#endif
)";

constexpr const char* kVertexInputs = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec2 uv;
layout(location = 0) out vec2 st;
vec3 unit(vec3 x) { return x * inversesqrt(dot(x, x)); }
vec3 in_frame(vec3 x) {
    vec3 bitangent = tangent.w * cross(normal, tangent.xyz);
    return vec3(dot(x, tangent.xyz), dot(x, bitangent), dot(x, normal));
}
)";

// The half vector and n.l per vertex. dot(2 texel - 256/255, h) = dot(texel, 2 h) - w.
constexpr const char* kModifiedVertex = R"(
layout(location = 1) out vec4 half_vector;
layout(location = 2) out float n_dot_l;
void main() {
    gl_Position = clip_from_object * vec4(position, 1.0);
    st = uv;
    vec3 h = in_frame(unit(light.xyz + unit(eye.xyz - position))) * (2.0 * REACH);
    half_vector = vec4(h, kZero * (h.x + h.y + h.z));
    n_dot_l = max(0.0, dot(normal, light.xyz)) * intensity.x;
}
)";

constexpr const char* kModifiedFragment = R"(
layout(location = 0) in vec2 st;
layout(location = 1) in vec4 half_vector;
layout(location = 2) in float n_dot_l;
layout(location = 0) out vec4 color;
UNIT(0) uniform sampler2D tangent_map;
UNIT(1) uniform sampler2D bitangent_map;
#ifdef SPECULAR_MAP
UNIT(2) uniform sampler2D specular_map;
#endif
void main() {
    float x = dot(texture(tangent_map, st).xyz, half_vector.xyz) - half_vector.w;
    float y = dot(texture(bitangent_map, st).xyz, half_vector.xyz) - half_vector.w;
    float lobe = max(0.0, 1.0 - x * x - y * y) * n_dot_l;
#ifdef SPECULAR_MAP
    color = vec4(texture(specular_map, st).rgb * lobe, 1.0);
#else
    color = vec4(lobe, lobe, lobe, 1.0);
#endif
}
)";

// Light and viewer in the tangent frame, normalised per pixel.
constexpr const char* kPixelVertex = R"(
layout(location = 1) out vec3 to_light;
layout(location = 2) out vec3 to_eye;
void main() {
    gl_Position = clip_from_object * vec4(position, 1.0);
    st = uv;
    to_light = in_frame(light.xyz);
    to_eye = in_frame(eye.xyz - position);
}
)";

constexpr const char* kPixelInputs = R"(
layout(location = 0) in vec2 st;
layout(location = 1) in vec3 to_light;
layout(location = 2) in vec3 to_eye;
layout(location = 0) out vec4 color;
vec3 unit(vec3 x) { return x * inversesqrt(dot(x, x)); }
)";

constexpr const char* kBlinnPhongFragment = R"(
UNIT(0) uniform sampler2D tangent_map;
UNIT(1) uniform sampler2D bitangent_map;
UNIT(2) uniform sampler2D normal_map;
UNIT(3) uniform sampler2D specular_map;
#ifdef POWER_TABLE
UNIT(4) uniform sampler2D power_table;
#endif
void main() {
    vec3 l = unit(to_light);
    vec3 h = unit(l + unit(to_eye)) * (2.0 * REACH);
    float zero = kZero * (h.x + h.y + h.z);
    float x = dot(texture(tangent_map, st).xyz, h) - zero;
    float y = dot(texture(bitangent_map, st).xyz, h) - zero;
    float s = max(0.0, 1.0 - x * x - y * y);
    float n_dot_l = 2.0 * (dot(texture(normal_map, st).xyz, l) - kZero * (l.x + l.y + l.z));
    vec4 specular = texture(specular_map, st);
#ifdef POWER_TABLE
    float lobe = texture(power_table, vec2(s, specular.a) * (255.0 / 256.0) + 0.5 / 256.0).r;
#else
    float lobe = pow(s, 0.5 * EXPONENT_LOW + 0.5 * (EXPONENT_HIGH - EXPONENT_LOW) * specular.a);
#endif
    color = vec4(specular.rgb * (lobe * max(0.0, n_dot_l) * intensity.x), 1.0);
}
)";

constexpr const char* kWardFragment = R"(
UNIT(0) uniform sampler2D tangent_map;
UNIT(1) uniform sampler2D bitangent_map;
UNIT(2) uniform sampler2D normal_map;
UNIT(3) uniform sampler2D specular_map;
void main() {
    vec3 l = unit(to_light);
    vec3 v = unit(to_eye);
    vec3 h = unit(l + v);
    float zero = kZero * (h.x + h.y + h.z);
    float x = dot(texture(tangent_map, st).xyz, h) - zero;
    float y = dot(texture(bitangent_map, st).xyz, h) - zero;
    vec3 n = texture(normal_map, st).xyz - kZero;
    float n_dot_l = max(0.0, 2.0 * dot(n, l));
    float n_dot_v = max(1.0 / 32.0, 2.0 * dot(n, v));
    float n_dot_h = max(1.0 / 32.0, dot(n, h));  // half of it, as x and y are
    const float kLog2OfE = 1.4426950408889634;
    float q = (x * x + y * y) * (REACH * REACH * -kLog2OfE);
    float lobe = n_dot_l * inversesqrt(max(n_dot_l * n_dot_v, 1e-12)) *
                 exp2(q / (n_dot_h * n_dot_h));
    color = vec4(texture(specular_map, st).rgb * (lobe * SPECULAR_SCALE * intensity.x), 1.0);
}
)";

constexpr const char* kBanksFragment = R"(
UNIT(0) uniform sampler2D tangent_map;
UNIT(1) uniform sampler2D normal_map;
UNIT(2) uniform sampler2D specular_map;
void main() {
    vec3 l = unit(to_light);
    vec3 v = unit(to_eye);
    vec3 t = 2.0 * texture(tangent_map, st).xyz - 2.0 * kZero;
    float a = dot(v, t);
    float c = dot(l, t);
    float lobe = max(0.0, sqrt(max(0.0, 1.0 - a * a)) * sqrt(max(0.0, 1.0 - c * c)) - a * c);
    float n_dot_l = 2.0 * (dot(texture(normal_map, st).xyz, l) - kZero * (l.x + l.y + l.z));
    vec4 specular = texture(specular_map, st);
    lobe = pow(lobe, EXPONENT_LOW + (EXPONENT_HIGH - EXPONENT_LOW) * specular.a);
    color = vec4(specular.rgb * (lobe * max(0.0, n_dot_l) * intensity.x), 1.0);
}
)";

constexpr const char* kTexturedVertex = R"(
layout(location = 1) out vec3 vertex_color;
void main() {
    gl_Position = clip_from_object * vec4(position, 1.0);
    st = uv;
    vertex_color = lit_base.rgb + lit_tint.rgb * max(0.0, dot(normal, light.xyz));
}
)";

constexpr const char* kTexturedFragment = R"(
layout(location = 0) in vec2 st;
layout(location = 1) in vec3 vertex_color;
layout(location = 0) out vec4 color;
UNIT(0) uniform sampler2D map;
void main() { color = vec4(texture(map, st).rgb * vertex_color, 1.0); }
)";

constexpr const char* kLayerVertex = R"(
void main() {
    gl_Position = clip_from_object * vec4(position, 1.0);
    st = uv;
}
)";

constexpr const char* kLayerFragment = R"(
layout(location = 0) in vec2 st;
layout(location = 0) out vec4 color;
UNIT(0) uniform sampler2D map;
void main() { color = texture(map, st); }
)";

constexpr const char* kPositionVertex = R"(
layout(location = 0) in vec3 position;
void main() { gl_Position = clip_from_object * vec4(position, 1.0); }
)";

constexpr const char* kFlatFragment = R"(
layout(location = 0) out vec4 color;
void main() { color = flat_color; }
)";

constexpr const char* kDepthFragment = R"(
void main() {}
)";

struct Parts {
    std::string vertex, fragment;
};

Parts parts_of(Shading shading) {
    const std::string inputs = kVertexInputs, pixel = kPixelInputs;
    switch (shading) {
        case Shading::modified:
            return {inputs + kModifiedVertex,
                    std::string("#define SPECULAR_MAP\n") + kModifiedFragment};
        case Shading::modified_constant:
            return {inputs + kModifiedVertex, kModifiedFragment};
        case Shading::power:
            return {inputs + kPixelVertex, pixel + kBlinnPhongFragment};
        case Shading::table:
            return {inputs + kPixelVertex, "#define POWER_TABLE\n" + pixel + kBlinnPhongFragment};
        case Shading::ward:
            return {inputs + kPixelVertex, pixel + kWardFragment};
        case Shading::banks:
            return {inputs + kPixelVertex, pixel + kBanksFragment};
        case Shading::textured:
            return {inputs + kTexturedVertex, kTexturedFragment};
        case Shading::flat:
            return {kPositionVertex, kFlatFragment};
        case Shading::layer:
            return {inputs + kLayerVertex, kLayerFragment};
        case Shading::depth:
            break;
    }
    return {kPositionVertex, kDepthFragment};
}

}  // namespace

ShaderSources shader_sources(Shading shading) {
    const Parts parts = parts_of(shading);
    return {kHeader + parts.vertex, kHeader + parts.fragment};
}

}  // namespace burnish::peers
