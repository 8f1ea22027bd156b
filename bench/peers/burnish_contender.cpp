#include <fmt/format.h>

#include <burnish/renderer.hpp>
#include <cstring>
#include <stdexcept>

#include "bench/peers/contender.hpp"

namespace burnish::peers {

namespace {

class BurnishContender : public Contender {
  public:
    BurnishContender(const PeerScene& scene, int threads)
        : m_peer(scene),
          m_renderer({.threads = threads}),
          m_frame(scene.scene.width, scene.scene.height, scene.scene.format) {}

    [[nodiscard]] std::string description() const override {
        return fmt::format("burnish, {}", m_renderer.isa());
    }

    void draw() override { m_renderer.render(m_peer.scene, m_frame); }

    [[nodiscard]] FrameBytes frame() override {
        const auto pixels =
            static_cast<std::size_t>(m_frame.width()) * static_cast<std::size_t>(m_frame.height());
        FrameBytes bytes(pixel_size(m_frame.format()) * pixels);
        std::memcpy(bytes.data(), m_frame.pixels(), bytes.size());
        return bytes;
    }

  private:
    const PeerScene& m_peer;
    Renderer m_renderer;
    Framebuffer m_frame;
};

}  // namespace

std::unique_ptr<Contender> make_burnish(const PeerScene& scene, int threads) {
    return std::make_unique<BurnishContender>(scene, threads);
}

std::unique_ptr<Contender> make_contender(std::string_view name, const PeerScene& scene,
                                          int threads) {
    if (name == "burnish") return make_burnish(scene, threads);
    if (name == "llvmpipe") return make_llvmpipe(scene, threads);
    if (name == "lavapipe") return make_lavapipe(scene, threads);
    if (name == "swiftshader") return make_swiftshader(scene);
    throw std::runtime_error(
        fmt::format("contender '{}', expected burnish, llvmpipe, lavapipe or swiftshader", name));
}

}  // namespace burnish::peers
