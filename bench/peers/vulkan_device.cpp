#include "bench/peers/vulkan_device.hpp"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>

namespace burnish::peers {

namespace {

/// Where Debian's package of Chromium keeps the description of its driver.
constexpr const char* kSwiftShader = "/usr/lib/chromium/vk_swiftshader_icd.json";

struct Known {
    vk::DriverId id;
    const char* expected;
};
Known known(VulkanDriver driver) {
    if (driver == VulkanDriver::lavapipe)
        return {vk::DriverId::eMesaLlvmpipe, "lavapipe (package mesa-vulkan-drivers)"};
    return {vk::DriverId::eGoogleSwiftshader,
            "SwiftShader (package chromium, or VK_DRIVER_FILES with its vk_swiftshader_icd.json)"};
}

vk::raii::Instance make_instance(const vk::raii::Context& context, VulkanDriver driver,
                                 int threads) {
    setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
    if (driver == VulkanDriver::swiftshader) setenv("VK_DRIVER_FILES", kSwiftShader, 0);
    const vk::ApplicationInfo application("burnish peers", 1, nullptr, 0, VK_API_VERSION_1_2);
    return {context, vk::InstanceCreateInfo({}, &application)};
}

vk::PhysicalDeviceDriverProperties driver_of(const vk::raii::PhysicalDevice& device) {
    return device
        .getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>()
        .get<vk::PhysicalDeviceDriverProperties>();
}

vk::raii::PhysicalDevice find_device(const vk::raii::Instance& instance, VulkanDriver driver) {
    const Known wanted = known(driver);
    try {
        for (const vk::raii::PhysicalDevice& device : instance.enumeratePhysicalDevices())
            if (driver_of(device).driverID == wanted.id) return device;
    } catch (const vk::SystemError& error) {
        throw std::runtime_error(
            fmt::format("Vulkan: {}, expected {}", error.what(), wanted.expected));
    }
    throw std::runtime_error(
        fmt::format("Vulkan has no such driver, expected {}", wanted.expected));
}

std::uint32_t graphics_family(const vk::raii::PhysicalDevice& device) {
    const std::vector<vk::QueueFamilyProperties> families = device.getQueueFamilyProperties();
    const auto found = std::ranges::find_if(families, [](const vk::QueueFamilyProperties& family) {
        return static_cast<bool>(family.queueFlags & vk::QueueFlagBits::eGraphics);
    });
    if (found == families.end()) throw std::runtime_error("Vulkan: no queue that draws");
    return static_cast<std::uint32_t>(found - families.begin());
}

vk::raii::Device make_device(const vk::raii::PhysicalDevice& physical, std::uint32_t family) {
    constexpr float kPriority = 1.0F;
    const vk::DeviceQueueCreateInfo queue({}, family, 1, &kPriority);
    return {physical, vk::DeviceCreateInfo({}, queue)};
}

}  // namespace

VulkanDevice::VulkanDevice(VulkanDriver driver, int threads)
    : m_instance(make_instance(m_context, driver, threads)),
      m_physical(find_device(m_instance, driver)),
      m_family(graphics_family(m_physical)),
      m_device(make_device(m_physical, m_family)),
      m_queue(m_device.getQueue(m_family, 0)),
      m_pool(m_device, vk::CommandPoolCreateInfo({}, m_family)),
      m_fence(m_device, vk::FenceCreateInfo{}) {}

std::string VulkanDevice::description() const {
    const vk::PhysicalDeviceDriverProperties driver = driver_of(m_physical);
    return fmt::format("{} ({}, {})", m_physical.getProperties().deviceName.data(),
                       driver.driverName.data(), driver.driverInfo.data());
}

vk::raii::DeviceMemory VulkanDevice::allocate(const vk::MemoryRequirements& needs) const {
    constexpr auto kWanted =
        vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent;
    const vk::PhysicalDeviceMemoryProperties memory = m_physical.getMemoryProperties();
    for (std::uint32_t type = 0; type < memory.memoryTypeCount; ++type)
        if ((needs.memoryTypeBits >> type & 1U) != 0 &&
            (memory.memoryTypes.at(type).propertyFlags & kWanted) == kWanted)
            return {m_device, vk::MemoryAllocateInfo(needs.size, type)};
    throw std::runtime_error("Vulkan: no memory that the host sees");
}

VulkanBuffer VulkanDevice::make_buffer(std::size_t bytes, vk::BufferUsageFlags usage) const {
    vk::raii::Buffer buffer(m_device, vk::BufferCreateInfo({}, bytes, usage));
    vk::raii::DeviceMemory memory = allocate(buffer.getMemoryRequirements());
    buffer.bindMemory(*memory, 0);
    return {std::move(memory), std::move(buffer)};
}

VulkanBuffer VulkanDevice::make_buffer(std::span<const std::byte> bytes,
                                       vk::BufferUsageFlags usage) const {
    VulkanBuffer made = make_buffer(bytes.size(), usage);
    std::memcpy(made.memory.mapMemory(0, bytes.size()), bytes.data(), bytes.size());
    made.memory.unmapMemory();
    return made;
}

VulkanImage VulkanDevice::make_image(vk::Extent2D size, std::uint32_t levels, vk::Format format,
                                     vk::ImageUsageFlags usage, vk::ImageAspectFlags aspect) const {
    vk::raii::Image image(
        m_device,
        vk::ImageCreateInfo({}, vk::ImageType::e2D, format, {size.width, size.height, 1}, levels, 1,
                            vk::SampleCountFlagBits::e1, vk::ImageTiling::eOptimal, usage));
    vk::raii::DeviceMemory memory = allocate(image.getMemoryRequirements());
    image.bindMemory(*memory, 0);
    vk::raii::ImageView view(m_device,
                             vk::ImageViewCreateInfo({}, *image, vk::ImageViewType::e2D, format, {},
                                                     {aspect, 0, levels, 0, 1}));
    return {std::move(memory), std::move(image), std::move(view), size, levels, aspect};
}

vk::raii::CommandBuffer VulkanDevice::make_commands() const {
    vk::raii::CommandBuffers made(
        m_device, vk::CommandBufferAllocateInfo(*m_pool, vk::CommandBufferLevel::ePrimary, 1));
    return std::move(made.front());
}

void VulkanDevice::run(const std::function<void(const vk::raii::CommandBuffer&)>& record) const {
    const vk::raii::CommandBuffer commands = make_commands();
    commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    record(commands);
    commands.end();
    submit_and_wait(commands);
}

void VulkanDevice::submit_and_wait(const vk::raii::CommandBuffer& commands) const {
    m_queue.submit(vk::SubmitInfo({}, {}, *commands), *m_fence);
    if (m_device.waitForFences(*m_fence, VK_TRUE, UINT64_MAX) != vk::Result::eSuccess)
        throw std::runtime_error("Vulkan: a frame does not end");
    m_device.resetFences(*m_fence);
}

void change_layout(const vk::raii::CommandBuffer& commands, const VulkanImage& image,
                   vk::ImageLayout from, vk::ImageLayout to) {
    constexpr auto kAll = vk::AccessFlagBits::eMemoryRead | vk::AccessFlagBits::eMemoryWrite;
    const vk::ImageMemoryBarrier barrier(kAll, kAll, from, to, VK_QUEUE_FAMILY_IGNORED,
                                         VK_QUEUE_FAMILY_IGNORED, *image.image,
                                         {image.aspect, 0, image.levels, 0, 1});
    commands.pipelineBarrier(vk::PipelineStageFlagBits::eAllCommands,
                             vk::PipelineStageFlagBits::eAllCommands, {}, {}, {}, barrier);
}

}  // namespace burnish::peers
