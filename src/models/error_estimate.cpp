#include "models/error_estimate.hpp"

#include <algorithm>
#include <array>
#include <burnish/framebuffer.hpp>
#include <burnish/mesh.hpp>
#include <burnish/renderer.hpp>
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "core/dmath.hpp"
#include "models/compile_model.hpp"
#include "models/map_sampler.hpp"
#include "models/model_texts.hpp"
#include "models/terms.hpp"
#include "models/texel.hpp"

namespace burnish {

namespace {

constexpr int kSide = 64;
constexpr int kGrid = 6561;

double radical_inverse(unsigned i, unsigned base) {
    double value = 0.0, digit = 1.0;
    for (; i > 0; i /= base) value += (digit /= base) * (i % base);
    return value;
}

glm::dvec3 unit(const glm::dvec3& v) {
    return v / std::sqrt(glm::dot(v, v));
}

struct Basis {
    glm::dvec3 x, y, z;
    explicit Basis(const glm::dvec3& axis) : z(axis) {
        const glm::dvec3 other = std::abs(z.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        x = unit(glm::cross(other, z));
        y = glm::cross(z, x);
    }
};

struct Sample {
    glm::dvec3 t, b, n;
    int x, y;
    double weight;
};

const double kLeastRadius = 1.0 / 64.0, kMostRadius = 4.0;

double density(const glm::dvec3& h, const TexelParameters& p) {
    const double cosine = glm::dot(h, p.n);
    if (cosine <= 0.0) return 0.0;
    const double u = glm::dot(h, p.t) / (cosine * p.alpha_x),
                 w = glm::dot(h, p.b) / (cosine * p.alpha_y);
    const double r = std::sqrt(u * u + w * w);
    const double even = 1.0 / (2.0 * dmath::kPi);
    if (r < kLeastRadius || r > kMostRadius) return 0.5 * even;
    const double octaves = 0.6931471805599453 * dmath::log2(kMostRadius / kLeastRadius);
    const double slopes = 1.0 / (2.0 * dmath::kPi * r * r * octaves * p.alpha_x * p.alpha_y);
    return 0.5 * (even + slopes / (cosine * cosine * cosine));
}

glm::dvec3 half_vector(const TexelParameters& p, bool lobe, double radial, double angle) {
    const double c = dmath::cos(2.0 * dmath::kPi * angle), s = dmath::sin(2.0 * dmath::kPi * angle);
    if (lobe) {
        const double r =
            kLeastRadius * dmath::exp2(radial * dmath::log2(kMostRadius / kLeastRadius));
        return unit(p.n + p.t * (p.alpha_x * r * c) + p.b * (p.alpha_y * r * s));
    }
    const double sine = std::sqrt(1.0 - radial * radial);
    return p.n * radial + (p.t * c + p.b * s) * sine;
}

std::vector<Sample> samples_for(const TexelSource& source, const glm::dvec3& h,
                                const glm::dvec3& l) {
    const Basis world(h);
    std::vector<Sample> samples;
    for (unsigned i = 1; samples.size() < kSide * kSide && i < 64 * kSide * kSide; ++i) {
        Sample s;
        s.x = static_cast<int>(radical_inverse(i, 2) * kGrid);
        s.y = static_cast<int>(radical_inverse(i, 3) * kGrid);
        const TexelParameters p =
            source.at(s.x * source.width() / kGrid, s.y * source.height() / kGrid);
        const bool lobe = radical_inverse(i, 11) < 0.5;
        const glm::dvec3 local = half_vector(p, lobe, radical_inverse(i, 5), radical_inverse(i, 7));
        const Basis from(local);
        const double turn = 2.0 * dmath::kPi * radical_inverse(i, 13);
        const glm::dvec3 x = world.x * dmath::cos(turn) + world.y * dmath::sin(turn);
        const glm::dvec3 y = glm::cross(h, x);
        const glm::dmat3 rotate =
            glm::dmat3(x, y, h) * glm::transpose(glm::dmat3(from.x, from.y, from.z));
        s.t = rotate[0];
        s.b = rotate[1];
        s.n = rotate[2];
        if (s.n.z <= 0.0 || glm::dot(s.n, l) <= 0.0) continue;
        s.weight = s.n.z / density(local, p);
        samples.push_back(s);
    }
    return samples;
}

double channel(const Texture& map, int x, int y, int c) {
    if (x < 0) return static_cast<double>(map.sampler().border[static_cast<std::size_t>(c)]);
    const bool words = has_words(map.format());
    const double most = map.is_signed(c) ? (words ? 32768.0 : 128.0) : (words ? 65535.0 : 255.0);
    return map.texel(0, 0, x, y, c) / most;
}

class Formula {
  public:
    Formula(const Material& material, const Machine& machine)
        : m_layer(material_layer(material, machine)),
          m_value(model_expression(material, m_builder)) {
        m_quantities = quantities_of(*m_value);
        std::vector<const Expr*> inputs = m_quantities;
        for (const char* name : {"l", "v", "h", "n_dot_l", "h_dot_l"}) {
            m_leaves.push_back(m_builder.leaf(name));
            inputs.push_back(m_leaves.back().get());
        }
        m_tape = std::make_unique<Tape>(std::vector<const Expr*>{m_value.get()}, inputs);
        m_inputs.resize(inputs.size());
    }
    glm::dvec3 at(const Sample& s, const glm::dvec3& l, const glm::dvec3& h) {
        std::size_t i = 0;
        for (const Expr* q : m_quantities) m_inputs[i++] = quantity(*q, s);
        const auto local = [&](const glm::dvec3& v) {
            return glm::dvec3(glm::dot(s.t, v), glm::dot(s.b, v), glm::dot(s.n, v));
        };
        m_inputs[i++] = local(l);
        m_inputs[i++] = local({0.0, 0.0, 1.0});
        m_inputs[i++] = local(h);
        m_inputs[i++] = glm::dvec3(std::max(0.0, glm::dot(s.n, l)));
        m_inputs[i++] = glm::dvec3(std::max(0.0, glm::dot(h, l)));
        glm::dvec3 value;
        m_tape->run(m_inputs.data(), &value);
        return value;
    }

  private:
    glm::dvec3 quantity(const Expr& e, const Sample& s) const {
        for (const LayerQuantity& q : m_layer) {
            if (q.name != e.name) continue;
            if (!q.texture) return q.components == 1 ? glm::dvec3(q.constant.x) : q.constant;
            const auto texel = [&](int i, int j) {
                glm::dvec3 value(0.0);
                for (int c = 0; c < q.components; ++c)
                    value[c] = channel(*q.texture, i, j, q.channel + c);
                return value;
            };
            const glm::dvec3 v =
                q.decoded(MapSampler(*q.texture, kGrid, kGrid).at(s.x, s.y, texel));
            return q.components == 1 ? glm::dvec3(v.x) : v;
        }
        return glm::dvec3(0.0);
    }
    ExprBuilder m_builder;
    std::vector<LayerQuantity> m_layer;
    ExprPtr m_value;
    std::vector<const Expr*> m_quantities;
    std::vector<ExprPtr> m_leaves;
    std::unique_ptr<Tape> m_tape;
    std::vector<glm::dvec3> m_inputs;
};

Mesh mesh_of(const std::vector<Sample>& samples) {
    MeshData data;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Sample& s = samples[i];
        const double column = static_cast<double>(i % kSide), row = static_cast<double>(i / kSide);
        for (const auto& [dx, dy] :
             {std::pair{0.1, 0.1}, std::pair{0.5, 0.9}, std::pair{0.9, 0.1}}) {
            data.positions.emplace_back(2.0 * (column + dx) / kSide - 1.0,
                                        1.0 - 2.0 * (row + dy) / kSide, 0.0);
            data.normals.emplace_back(s.n);
            data.tangents.emplace_back(glm::vec3(s.t), 1.0F);
            data.uvs.emplace_back((s.x + 0.5) / kGrid, 1.0 - (s.y + 0.5) / kGrid);
            data.indices.push_back(static_cast<std::uint32_t>(data.indices.size()));
        }
    }
    return Mesh(data);
}

struct Difference {
    double absolute, weight;
};

}  // namespace

ErrorEstimate estimate_error(const Material& material, const Machine& machine) {
    Formula formula(material, machine);
    const TexelSource source(material);
    struct Case {
        glm::dvec3 l, h;
        std::vector<Sample> samples;
        std::vector<glm::dvec3> want;
        double peak = 0.0;
    };
    std::vector<Case> cases;
    double least_peak = 1e30;
    for (const double degrees : {40.0, 80.0}) {
        const double angle = degrees * (dmath::kPi / 180.0);
        Case c;
        c.l = {dmath::sin(angle), 0.0, dmath::cos(angle)};
        c.h = unit(c.l + glm::dvec3(0, 0, 1));
        c.samples = samples_for(source, c.h, c.l);
        for (const Sample& s : c.samples) {
            c.want.push_back(formula.at(s, c.l, c.h));
            if (s.n.z < 0.125) continue;
            const glm::dvec3& w = c.want.back();
            c.peak = std::max({c.peak, w.x, w.y, w.z});
        }
        least_peak = std::min(least_peak, c.peak);
        cases.push_back(std::move(c));
    }
    const double intensity = least_peak > 0.0 ? 0.9 / least_peak : 1.0;
    ErrorEstimate estimate;
    Renderer renderer({.threads = 1});
    const auto shared = std::make_shared<const Material>(material);
    for (const Case& c : cases) {
        Scene scene;
        scene.machine = machine;
        scene.machine.viewer = Viewer::infinite;
        scene.camera.view = glm::mat4(1.0F);
        scene.camera.projection = glm::mat4(1.0F);
        scene.background = glm::vec4(0.0F);
        scene.format = PixelFormat::rgba32f;
        scene.lights.push_back(
            {.position = glm::vec3(c.l), .intensity = static_cast<float>(intensity)});
        scene.objects.push_back({mesh_of(c.samples), shared, glm::mat4(1.0F), {}});
        Framebuffer frame(kSide, kSide, PixelFormat::rgba32f);
        renderer.render(scene, frame);
        std::vector<Difference> bright, dark;
        double bw = 0, dw = 0, bs = 0, ds = 0;
        for (std::size_t i = 0; i < c.samples.size(); ++i) {
            glm::vec4 got;
            std::memcpy(&got, frame.row(static_cast<int>(i / kSide)) + i % kSide * sizeof got,
                        sizeof got);
            const glm::dvec3 want = glm::min(c.want[i] * intensity, glm::dvec3(1.0));
            const double top = std::max({want.x, want.y, want.z});
            const bool lobe = top > 0.5 * 0.9;
            const double w = c.samples[i].weight;
            for (int k = 0; k < 3; ++k) {
                const double d = std::abs(got[k] - want[k]);
                (lobe ? bright : dark).push_back({d, w});
                (lobe ? bs : ds) += w * d * d;
                (lobe ? bw : dw) += w;
            }
        }
        const double f = bw / (bw + dw), share = std::max(f, 0.1);
        const double rms =
            std::sqrt(share * (bw > 0 ? bs / bw : 0.0) + (1 - share) * (dw > 0 ? ds / dw : 0.0));
        for (auto& d : bright) d.weight *= share / bw;
        for (auto& d : dark) d.weight *= (1 - share) / dw;
        std::vector<Difference> all = bright;
        all.insert(all.end(), dark.begin(), dark.end());
        std::sort(all.begin(), all.end(), [](auto& a, auto& b) { return a.absolute > b.absolute; });
        double sum = 0.0;
        std::size_t at = 0;
        while (at + 1 < all.size() && (sum += all[at].weight) < 0.01) ++at;
        estimate.rms = std::max(estimate.rms, rms);
        estimate.largest = std::max(estimate.largest, all[at].absolute);
    }
    return estimate;
}

}  // namespace burnish
