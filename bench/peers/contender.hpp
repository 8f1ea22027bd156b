#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bench/peers/peer_scene.hpp"

namespace burnish::peers {

/// A finished frame: rows packed, row 0 on top. Bytes r, g, b, a of each pixel, or with
/// Shading::depth one float, the window depth 0 .. 1.
using FrameBytes = std::vector<std::byte>;

/// A renderer with one scene in its memory.
class Contender {
  public:
    virtual ~Contender() = default;
    /// The renderer's version, and what it was told to use.
    [[nodiscard]] virtual std::string description() const = 0;
    /// Clears, draws, and returns when the frame lies in memory, row by row.
    virtual void draw() = 0;
    /// The frame that draw() left.
    [[nodiscard]] virtual FrameBytes frame() = 0;
};

/// `scene` must outlive the contender. Threads are those that turn triangles into pixels.
std::unique_ptr<Contender> make_burnish(const PeerScene& scene, int threads);
/// Mesa's software renderer for OpenGL, without a display. Sets the environment that it reads.
/// Throws std::runtime_error where OpenGL 4.5 is not to be had, or another renderer answers.
std::unique_ptr<Contender> make_llvmpipe(const PeerScene& scene, int threads);

/// Mesa's software renderer for Vulkan. The same, where Vulkan 1.2 is not to be had.
std::unique_ptr<Contender> make_lavapipe(const PeerScene& scene, int threads);
/// Google's, which has a thread for every core.
std::unique_ptr<Contender> make_swiftshader(const PeerScene& scene);

/// "burnish", "llvmpipe", "lavapipe" or "swiftshader". Throws std::runtime_error for another name.
std::unique_ptr<Contender> make_contender(std::string_view name, const PeerScene& scene,
                                          int threads);

}  // namespace burnish::peers
