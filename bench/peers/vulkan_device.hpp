#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

namespace burnish::peers {

/// Drivers of Vulkan that draw on the CPU.
enum class VulkanDriver { lavapipe, swiftshader };

struct VulkanBuffer {
    vk::raii::DeviceMemory memory;
    vk::raii::Buffer buffer;
};

struct VulkanImage {
    vk::raii::DeviceMemory memory;
    vk::raii::Image image;
    vk::raii::ImageView view;
    vk::Extent2D size;
    std::uint32_t levels = 1;
    vk::ImageAspectFlags aspect;
};

/// A device with one queue, and objects in its memory, which is the host's.
class VulkanDevice {
  public:
    /// Sets the environment that the driver and the loader read, but not the place of SwiftShader
    /// where the user did. `threads` is for lavapipe; SwiftShader has a thread for each core.
    /// Throws std::runtime_error where the driver is not to be had.
    VulkanDevice(VulkanDriver driver, int threads);

    /// The renderer's version.
    [[nodiscard]] std::string description() const;
    [[nodiscard]] const vk::raii::Device& device() const { return m_device; }

    [[nodiscard]] VulkanBuffer make_buffer(std::size_t bytes, vk::BufferUsageFlags usage) const;
    [[nodiscard]] VulkanBuffer make_buffer(std::span<const std::byte> bytes,
                                           vk::BufferUsageFlags usage) const;
    [[nodiscard]] VulkanImage make_image(vk::Extent2D size, std::uint32_t levels, vk::Format format,
                                         vk::ImageUsageFlags usage,
                                         vk::ImageAspectFlags aspect) const;

    [[nodiscard]] vk::raii::CommandBuffer make_commands() const;
    /// Records, draws, and returns when all is done.
    void run(const std::function<void(const vk::raii::CommandBuffer&)>& record) const;
    void submit_and_wait(const vk::raii::CommandBuffer& commands) const;

  private:
    [[nodiscard]] vk::raii::DeviceMemory allocate(const vk::MemoryRequirements& needs) const;

    vk::raii::Context m_context;
    vk::raii::Instance m_instance;
    vk::raii::PhysicalDevice m_physical;
    std::uint32_t m_family;
    vk::raii::Device m_device;
    vk::raii::Queue m_queue;
    vk::raii::CommandPool m_pool;
    vk::raii::Fence m_fence;
};

/// Every level from one layout to another; waits for all that went before.
void change_layout(const vk::raii::CommandBuffer& commands, const VulkanImage& image,
                   vk::ImageLayout from, vk::ImageLayout to);

template <class T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

}  // namespace burnish::peers
