#include <array>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <stdexcept>
#include <variant>

#include "bench/peers/contender.hpp"
#include "bench/peers/peer_inputs.hpp"
#include "bench/peers/peer_textures.hpp"
#include "bench/peers/shaders.hpp"
#include "bench/peers/spirv.hpp"
#include "bench/peers/vulkan_device.hpp"

namespace burnish::peers {

namespace {

struct VulkanObject {
    VulkanBuffer vertices, indices;
    std::uint32_t index_count = 0;
};

struct VulkanTexture {
    VulkanImage image;
    vk::raii::Sampler sampler;
};

VulkanObject upload(const VulkanDevice& device, const Mesh& mesh) {
    const std::vector<std::uint32_t> indices(mesh.indices().begin(), mesh.indices().end());
    return {device.make_buffer(bytes_of(vertices_of(mesh)), vk::BufferUsageFlagBits::eVertexBuffer),
            device.make_buffer(bytes_of(indices), vk::BufferUsageFlagBits::eIndexBuffer),
            static_cast<std::uint32_t>(indices.size())};
}

vk::SamplerAddressMode address_mode(Wrap wrap) {
    return wrap == Wrap::repeat ? vk::SamplerAddressMode::eRepeat
                                : vk::SamplerAddressMode::eClampToEdge;
}

vk::raii::Sampler make_sampler(const VulkanDevice& device, const Sampler& sampler) {
    const bool trilinear = sampler.filter == Filter::linear_mipmap_linear;
    vk::SamplerCreateInfo info(
        {}, vk::Filter::eLinear, vk::Filter::eLinear,
        trilinear ? vk::SamplerMipmapMode::eLinear : vk::SamplerMipmapMode::eNearest,
        address_mode(sampler.wrap_s), address_mode(sampler.wrap_t));
    info.maxLod = trilinear ? VK_LOD_CLAMP_NONE : 0.0F;
    return {device.device(), info};
}

VulkanTexture upload(const VulkanDevice& device, const Texture& texture) {
    const auto levels = static_cast<std::uint32_t>(texture.levels().size());
    VulkanImage image = device.make_image(
        {static_cast<std::uint32_t>(texture.width()), static_cast<std::uint32_t>(texture.height())},
        levels, vk::Format::eR8G8B8A8Unorm,
        vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst,
        vk::ImageAspectFlagBits::eColor);
    std::vector<VulkanBuffer> staging;
    device.run([&](const vk::raii::CommandBuffer& commands) {
        change_layout(commands, image, vk::ImageLayout::eUndefined,
                      vk::ImageLayout::eTransferDstOptimal);
        for (std::uint32_t level = 0; level < levels; ++level) {
            const Image8 texels = texels_of(texture, level);
            staging.push_back(
                device.make_buffer(bytes_of(texels.rgba), vk::BufferUsageFlagBits::eTransferSrc));
            commands.copyBufferToImage(
                *staging.back().buffer, *image.image, vk::ImageLayout::eTransferDstOptimal,
                vk::BufferImageCopy(0, 0, 0, {image.aspect, level, 0, 1}, {},
                                    {static_cast<std::uint32_t>(texels.width),
                                     static_cast<std::uint32_t>(texels.height), 1}));
        }
        change_layout(commands, image, vk::ImageLayout::eTransferDstOptimal,
                      vk::ImageLayout::eShaderReadOnlyOptimal);
    });
    return {std::move(image), make_sampler(device, texture.sampler())};
}

vk::raii::ShaderModule compiled(const VulkanDevice& device, ShaderStage stage,
                                const std::string& source) {
    const std::vector<std::uint32_t> words = spirv_of(stage, source);
    return {device.device(), vk::ShaderModuleCreateInfo({}, words)};
}

/// Textures as colour and depth of a frame, and the pass that clears and fills them.
struct FrameImages {
    std::vector<VulkanImage> images;  ///< colour, unless depth is the frame; depth, if there is one
    vk::raii::RenderPass pass;
    vk::raii::Framebuffer framebuffer;
    vk::Extent2D size;
    bool is_depth = false;

    /// The image that is the frame, in the layout eTransferSrcOptimal after the pass.
    [[nodiscard]] const VulkanImage& frame() const { return images.front(); }
};

FrameImages make_frame(const VulkanDevice& device, const PeerScene& peer) {
    const vk::Extent2D size(static_cast<std::uint32_t>(peer.scene.width),
                            static_cast<std::uint32_t>(peer.scene.height));
    const bool is_depth = peer.shading == Shading::depth;
    std::vector<VulkanImage> images;
    std::vector<vk::AttachmentDescription> attachments;
    std::vector<vk::ImageView> views;
    const auto attach = [&](vk::Format format, vk::ImageUsageFlags usage,
                            vk::ImageAspectFlags aspect, bool is_frame) {
        images.push_back(device.make_image(size, 1, format,
                                           usage | vk::ImageUsageFlagBits::eTransferSrc, aspect));
        views.push_back(*images.back().view);
        attachments.emplace_back(
            vk::AttachmentDescriptionFlags{}, format, vk::SampleCountFlagBits::e1,
            vk::AttachmentLoadOp::eClear,
            is_frame ? vk::AttachmentStoreOp::eStore : vk::AttachmentStoreOp::eDontCare,
            vk::AttachmentLoadOp::eDontCare, vk::AttachmentStoreOp::eDontCare,
            vk::ImageLayout::eUndefined, vk::ImageLayout::eTransferSrcOptimal);
    };
    vk::SubpassDescription subpass;
    const vk::AttachmentReference color(0, vk::ImageLayout::eColorAttachmentOptimal);
    if (!is_depth) {
        attach(vk::Format::eR8G8B8A8Unorm, vk::ImageUsageFlagBits::eColorAttachment,
               vk::ImageAspectFlagBits::eColor, true);
        subpass.setColorAttachments(color);
    }
    const vk::AttachmentReference depth(static_cast<std::uint32_t>(images.size()),
                                        vk::ImageLayout::eDepthStencilAttachmentOptimal);
    if (peer.depth_buffer) {
        attach(vk::Format::eD32Sfloat, vk::ImageUsageFlagBits::eDepthStencilAttachment,
               vk::ImageAspectFlagBits::eDepth, is_depth);
        subpass.setPDepthStencilAttachment(&depth);
    }
    vk::raii::RenderPass pass(device.device(), vk::RenderPassCreateInfo({}, attachments, subpass));
    vk::raii::Framebuffer framebuffer(
        device.device(), vk::FramebufferCreateInfo({}, *pass, views, size.width, size.height, 1));
    return {std::move(images), std::move(pass), std::move(framebuffer), size, is_depth};
}

vk::BlendFactor blend_factor(BlendFactor factor) {
    switch (factor) {
        case BlendFactor::src_alpha:
            return vk::BlendFactor::eSrcAlpha;
        case BlendFactor::one_minus_src_alpha:
            return vk::BlendFactor::eOneMinusSrcAlpha;
        default:
            throw std::runtime_error("blend factor that no scene of the comparison has");
    }
}

vk::PipelineColorBlendAttachmentState blend_state(const RasterState& raster) {
    using Channel = vk::ColorComponentFlagBits;
    vk::PipelineColorBlendAttachmentState state;
    state.colorWriteMask = Channel::eR | Channel::eG | Channel::eB | Channel::eA;
    if (!raster.blend) return state;
    state.blendEnable = VK_TRUE;
    state.srcColorBlendFactor = state.srcAlphaBlendFactor = blend_factor(raster.blend->src);
    state.dstColorBlendFactor = state.dstAlphaBlendFactor = blend_factor(raster.blend->dst);
    return state;
}

/// All objects of a scene have one state and one program.
vk::raii::Pipeline make_pipeline(const VulkanDevice& device, const PeerScene& peer,
                                 const FrameImages& frame, vk::PipelineLayout layout) {
    const ShaderSources sources = shader_sources(peer.shading);
    const vk::raii::ShaderModule vertex = compiled(device, ShaderStage::vertex, sources.vertex);
    const vk::raii::ShaderModule fragment =
        compiled(device, ShaderStage::fragment, sources.fragment);
    const std::array stages{
        vk::PipelineShaderStageCreateInfo({}, vk::ShaderStageFlagBits::eVertex, *vertex, "main"),
        vk::PipelineShaderStageCreateInfo({}, vk::ShaderStageFlagBits::eFragment, *fragment,
                                          "main")};
    const vk::VertexInputBindingDescription binding(0, sizeof(PeerVertex));
    const std::array attributes{
        vk::VertexInputAttributeDescription(0, 0, vk::Format::eR32G32B32Sfloat,
                                            offsetof(PeerVertex, position)),
        vk::VertexInputAttributeDescription(1, 0, vk::Format::eR32G32B32Sfloat,
                                            offsetof(PeerVertex, normal)),
        vk::VertexInputAttributeDescription(2, 0, vk::Format::eR32G32B32A32Sfloat,
                                            offsetof(PeerVertex, tangent)),
        vk::VertexInputAttributeDescription(3, 0, vk::Format::eR32G32Sfloat,
                                            offsetof(PeerVertex, uv))};
    const vk::PipelineVertexInputStateCreateInfo inputs({}, binding, attributes);
    const vk::PipelineInputAssemblyStateCreateInfo assembly({},
                                                            vk::PrimitiveTopology::eTriangleList);
    // A height below 0 has row 0 on top, with y upward in clip space, as OpenGL has it.
    const auto width = static_cast<float>(frame.size.width);
    const auto height = static_cast<float>(frame.size.height);
    const vk::Viewport viewport(0.0F, height, width, -height, 0.0F, 1.0F);
    const vk::Rect2D scissor({}, frame.size);
    const vk::PipelineViewportStateCreateInfo view({}, viewport, scissor);
    const RasterState& raster = peer.scene.objects.front().raster;
    vk::PipelineRasterizationStateCreateInfo rasterization;
    rasterization.cullMode =
        raster.cull == Cull::back ? vk::CullModeFlagBits::eBack : vk::CullModeFlagBits::eNone;
    rasterization.frontFace = vk::FrontFace::eCounterClockwise;
    rasterization.lineWidth = 1.0F;
    const vk::PipelineMultisampleStateCreateInfo multisample;
    const bool tests = raster.depth_test == DepthTest::less;
    const vk::PipelineDepthStencilStateCreateInfo depth({}, tests, tests, vk::CompareOp::eLess);
    const vk::PipelineColorBlendAttachmentState attachment = blend_state(raster);
    vk::PipelineColorBlendStateCreateInfo blend;
    if (!frame.is_depth) blend.setAttachments(attachment);
    return {device.device(), nullptr,
            vk::GraphicsPipelineCreateInfo({}, stages, &inputs, &assembly, nullptr, &view,
                                           &rasterization, &multisample, &depth, &blend, nullptr,
                                           layout, *frame.pass)};
}

/// Clip space of Vulkan has z of 0 .. w.
FrameBlock vulkan_block(const PeerScene& peer) {
    FrameBlock block = frame_block(peer);
    const glm::mat4 half = glm::scale(glm::mat4(1.0F), glm::vec3(1.0F, 1.0F, 0.5F));
    block.clip_from_object = glm::translate(glm::mat4(1.0F), glm::vec3(0.0F, 0.0F, 0.5F)) * half *
                             block.clip_from_object;
    return block;
}

class VulkanContender : public Contender {
  public:
    VulkanContender(const PeerScene& peer, VulkanDriver driver, int threads)
        : m_device(driver, threads),
          m_frame(make_frame(m_device, peer)),
          m_block(m_device.make_buffer(bytes_of(std::vector{vulkan_block(peer)}),
                                       vk::BufferUsageFlagBits::eUniformBuffer)) {
        for (const Object& object : peer.scene.objects)
            m_objects.push_back(upload(m_device, std::get<Mesh>(object.geometry)));
        for (const TexturePtr& texture : peer.textures)
            m_textures.push_back(upload(m_device, *texture));
        make_sets();
        const std::array layouts{*m_set_layouts[0], *m_set_layouts[1]};
        m_layout = {m_device.device(), vk::PipelineLayoutCreateInfo({}, layouts)};
        m_pipeline = make_pipeline(m_device, peer, m_frame, *m_layout);
        record();
    }

    [[nodiscard]] std::string description() const override { return m_device.description(); }

    void draw() override { m_device.submit_and_wait(m_commands); }

    [[nodiscard]] FrameBytes frame() override {
        const std::size_t size = 4UL * m_frame.size.width * m_frame.size.height;
        const VulkanBuffer buffer =
            m_device.make_buffer(size, vk::BufferUsageFlagBits::eTransferDst);
        m_device.run([&](const vk::raii::CommandBuffer& commands) {
            commands.copyImageToBuffer(
                *m_frame.frame().image, vk::ImageLayout::eTransferSrcOptimal, *buffer.buffer,
                vk::BufferImageCopy(0, 0, 0, {m_frame.frame().aspect, 0, 0, 1}, {},
                                    {m_frame.size.width, m_frame.size.height, 1}));
        });
        FrameBytes bytes(size);
        std::memcpy(bytes.data(), buffer.memory.mapMemory(0, size), size);
        buffer.memory.unmapMemory();
        return bytes;
    }

  private:
    /// Set 0 has the uniform block, set 1 the textures.
    void make_sets() {
        const auto units = static_cast<std::uint32_t>(m_textures.size());
        const vk::raii::Device& device = m_device.device();
        const vk::DescriptorSetLayoutBinding block(0, vk::DescriptorType::eUniformBuffer, 1,
                                                   vk::ShaderStageFlagBits::eAllGraphics);
        std::vector<vk::DescriptorSetLayoutBinding> samplers;
        for (std::uint32_t unit = 0; unit < units; ++unit)
            samplers.emplace_back(unit, vk::DescriptorType::eCombinedImageSampler, 1,
                                  vk::ShaderStageFlagBits::eFragment);
        m_set_layouts.emplace_back(device, vk::DescriptorSetLayoutCreateInfo({}, block));
        m_set_layouts.emplace_back(device, vk::DescriptorSetLayoutCreateInfo({}, samplers));
        const std::array sizes{
            vk::DescriptorPoolSize(vk::DescriptorType::eUniformBuffer, 1),
            vk::DescriptorPoolSize(vk::DescriptorType::eCombinedImageSampler, units + 1)};
        m_set_pool = {device, vk::DescriptorPoolCreateInfo(
                                  vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 2, sizes)};
        const std::array layouts{*m_set_layouts[0], *m_set_layouts[1]};
        for (vk::raii::DescriptorSet& set :
             vk::raii::DescriptorSets(device, vk::DescriptorSetAllocateInfo(*m_set_pool, layouts)))
            m_sets.push_back(std::move(set));
        const vk::DescriptorBufferInfo whole(*m_block.buffer, 0, sizeof(FrameBlock));
        device.updateDescriptorSets(
            vk::WriteDescriptorSet(*m_sets[0], 0, 0, vk::DescriptorType::eUniformBuffer, {}, whole),
            {});
        for (std::uint32_t unit = 0; unit < units; ++unit) {
            const vk::DescriptorImageInfo image(*m_textures[unit].sampler,
                                                *m_textures[unit].image.view,
                                                vk::ImageLayout::eShaderReadOnlyOptimal);
            device.updateDescriptorSets(
                vk::WriteDescriptorSet(*m_sets[1], unit, 0,
                                       vk::DescriptorType::eCombinedImageSampler, image),
                {});
        }
    }

    /// The frame, to be submitted again and again.
    void record() {
        m_commands = m_device.make_commands();
        m_commands.begin(vk::CommandBufferBeginInfo{});
        std::vector<vk::ClearValue> clear(m_frame.images.size(), vk::ClearDepthStencilValue(1.0F));
        if (!m_frame.is_depth) clear.front() = vk::ClearColorValue(std::array<float, 4>{});
        m_commands.beginRenderPass(
            vk::RenderPassBeginInfo(*m_frame.pass, *m_frame.framebuffer, {{}, m_frame.size}, clear),
            vk::SubpassContents::eInline);
        m_commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *m_pipeline);
        const std::array sets{*m_sets[0], *m_sets[1]};
        m_commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *m_layout, 0, sets, {});
        for (const VulkanObject& object : m_objects) {
            m_commands.bindVertexBuffers(0, *object.vertices.buffer, vk::DeviceSize(0));
            m_commands.bindIndexBuffer(*object.indices.buffer, 0, vk::IndexType::eUint32);
            m_commands.drawIndexed(object.index_count, 1, 0, 0, 0);
        }
        m_commands.endRenderPass();
        m_commands.end();
    }

    VulkanDevice m_device;
    FrameImages m_frame;
    VulkanBuffer m_block;
    std::vector<VulkanObject> m_objects;
    std::vector<VulkanTexture> m_textures;
    std::vector<vk::raii::DescriptorSetLayout> m_set_layouts;
    vk::raii::DescriptorPool m_set_pool = nullptr;
    std::vector<vk::raii::DescriptorSet> m_sets;
    vk::raii::PipelineLayout m_layout = nullptr;
    vk::raii::Pipeline m_pipeline = nullptr;
    vk::raii::CommandBuffer m_commands = nullptr;
};

}  // namespace

std::unique_ptr<Contender> make_lavapipe(const PeerScene& scene, int threads) {
    return std::make_unique<VulkanContender>(scene, VulkanDriver::lavapipe, threads);
}

std::unique_ptr<Contender> make_swiftshader(const PeerScene& scene) {
    return std::make_unique<VulkanContender>(scene, VulkanDriver::swiftshader, 0);
}

}  // namespace burnish::peers
