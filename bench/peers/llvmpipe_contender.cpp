#include <epoxy/gl.h>
#include <fmt/format.h>

#include <cstddef>
#include <stdexcept>
#include <variant>

#include "bench/peers/contender.hpp"
#include "bench/peers/gl_context.hpp"
#include "bench/peers/peer_inputs.hpp"
#include "bench/peers/peer_textures.hpp"
#include "bench/peers/shaders.hpp"

namespace burnish::peers {

namespace {

struct GlObject {
    GLuint vertex_array = 0;
    GLsizei index_count = 0;
};

void attribute(GLuint array, GLuint location, GLint components, std::size_t offset) {
    glEnableVertexArrayAttrib(array, location);
    glVertexArrayAttribFormat(array, location, components, GL_FLOAT, GL_FALSE,
                              static_cast<GLuint>(offset));
    glVertexArrayAttribBinding(array, location, 0);
}

template <class T>
GLuint buffer_of(const std::vector<T>& data) {
    GLuint buffer = 0;
    glCreateBuffers(1, &buffer);
    glNamedBufferStorage(buffer, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), 0);
    return buffer;
}

GlObject upload(const Mesh& mesh) {
    const std::vector<std::uint32_t> indices(mesh.indices().begin(), mesh.indices().end());
    GlObject object;
    object.index_count = static_cast<GLsizei>(indices.size());
    glCreateVertexArrays(1, &object.vertex_array);
    const GLuint array = object.vertex_array;
    glVertexArrayVertexBuffer(array, 0, buffer_of(vertices_of(mesh)), 0, sizeof(PeerVertex));
    glVertexArrayElementBuffer(array, buffer_of(indices));
    attribute(array, 0, 3, offsetof(PeerVertex, position));
    attribute(array, 1, 3, offsetof(PeerVertex, normal));
    attribute(array, 2, 4, offsetof(PeerVertex, tangent));
    attribute(array, 3, 2, offsetof(PeerVertex, uv));
    return object;
}

GLint gl_wrap(Wrap wrap) {
    return wrap == Wrap::repeat ? GL_REPEAT : GL_CLAMP_TO_EDGE;
}

GLuint upload(const Texture& texture) {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    const auto levels = static_cast<GLsizei>(texture.levels().size());
    glTextureStorage2D(name, levels, GL_RGBA8, texture.width(), texture.height());
    for (GLint level = 0; level < levels; ++level) {
        const Image8 image = texels_of(texture, static_cast<std::size_t>(level));
        glTextureSubImage2D(name, level, 0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE,
                            image.rgba.data());
    }
    const Sampler& sampler = texture.sampler();
    const bool trilinear = sampler.filter == Filter::linear_mipmap_linear;
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER,
                        trilinear ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTextureParameteri(name, GL_TEXTURE_WRAP_S, gl_wrap(sampler.wrap_s));
    glTextureParameteri(name, GL_TEXTURE_WRAP_T, gl_wrap(sampler.wrap_t));
    return name;
}

GLuint compiled(GLenum kind, const std::string& source) {
    const GLuint shader = glCreateShader(kind);
    const char* text = source.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good == GL_TRUE) return shader;
    std::string log(4096, '\0');
    GLsizei length = 0;
    glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    throw std::runtime_error("GLSL: " + log + source);
}

GLuint linked(const ShaderSources& sources) {
    const GLuint program = glCreateProgram();
    glAttachShader(program, compiled(GL_VERTEX_SHADER, sources.vertex));
    glAttachShader(program, compiled(GL_FRAGMENT_SHADER, sources.fragment));
    glLinkProgram(program);
    GLint good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (good != GL_TRUE) throw std::runtime_error("GLSL: program does not link");
    return program;
}

/// Textures as colour and depth of a frame: they lie in memory row by row.
class FrameTextures {
  public:
    FrameTextures(const PeerScene& peer)
        : m_width(peer.scene.width),
          m_height(peer.scene.height),
          m_is_depth(peer.shading == Shading::depth) {
        glCreateFramebuffers(1, &m_framebuffer);
        if (m_is_depth) {
            glNamedFramebufferDrawBuffer(m_framebuffer, GL_NONE);
        } else {
            attach(GL_COLOR_ATTACHMENT0, GL_RGBA8);
        }
        if (peer.depth_buffer) attach(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT32F);
        if (glCheckNamedFramebufferStatus(m_framebuffer, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
            throw std::runtime_error("framebuffer is incomplete");
        glBindFramebuffer(GL_FRAMEBUFFER, m_framebuffer);
        glViewport(0, 0, m_width, m_height);
    }

    [[nodiscard]] FrameBytes read() const {
        FrameBytes bytes(4 * static_cast<std::size_t>(m_width) *
                         static_cast<std::size_t>(m_height));
        glReadPixels(0, 0, m_width, m_height, m_is_depth ? GL_DEPTH_COMPONENT : GL_RGBA,
                     m_is_depth ? GL_FLOAT : GL_UNSIGNED_BYTE, bytes.data());
        return bytes;
    }

  private:
    void attach(GLenum point, GLenum format) {
        GLuint texture = 0;
        glCreateTextures(GL_TEXTURE_2D, 1, &texture);
        glTextureStorage2D(texture, 1, format, m_width, m_height);
        glNamedFramebufferTexture(m_framebuffer, point, texture, 0);
    }

    int m_width, m_height;
    bool m_is_depth;
    GLuint m_framebuffer = 0;
};

GLenum gl_factor(BlendFactor factor) {
    switch (factor) {
        case BlendFactor::src_alpha:
            return GL_SRC_ALPHA;
        case BlendFactor::one_minus_src_alpha:
            return GL_ONE_MINUS_SRC_ALPHA;
        default:
            throw std::runtime_error("blend factor that no scene of the comparison has");
    }
}

/// All objects of a scene have one state.
void set_state(const RasterState& raster) {
    glClipControl(GL_UPPER_LEFT, GL_NEGATIVE_ONE_TO_ONE);  // row 0 on top
    glClearColor(0.0F, 0.0F, 0.0F, 0.0F);
    if (raster.cull == Cull::back) glEnable(GL_CULL_FACE);
    if (raster.depth_test == DepthTest::less) {
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LESS);
    }
    if (raster.blend) {
        glEnable(GL_BLEND);
        glBlendFunc(gl_factor(raster.blend->src), gl_factor(raster.blend->dst));
    }
}

class LlvmpipeContender : public Contender {
  public:
    LlvmpipeContender(const PeerScene& peer, int threads) : m_context(threads), m_frame(peer) {
        for (const Object& object : peer.scene.objects)
            m_objects.push_back(upload(std::get<Mesh>(object.geometry)));
        for (GLuint unit = 0; unit < peer.textures.size(); ++unit)
            glBindTextureUnit(unit, upload(*peer.textures[unit]));
        set_state(peer.scene.objects.front().raster);
        glBindBufferBase(GL_UNIFORM_BUFFER, 0, buffer_of(std::vector{frame_block(peer)}));
        glUseProgram(linked(shader_sources(peer.shading)));
    }

    [[nodiscard]] std::string description() const override { return m_context.description(); }

    void draw() override {
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        for (const GlObject& object : m_objects) {
            glBindVertexArray(object.vertex_array);
            glDrawElements(GL_TRIANGLES, object.index_count, GL_UNSIGNED_INT, nullptr);
        }
        glFinish();
    }

    [[nodiscard]] FrameBytes frame() override {
        FrameBytes bytes = m_frame.read();
        if (const GLenum error = glGetError(); error != GL_NO_ERROR)
            throw std::runtime_error(fmt::format("OpenGL error 0x{:x}", error));
        return bytes;
    }

  private:
    GlContext m_context;
    FrameTextures m_frame;
    std::vector<GlObject> m_objects;
};

}  // namespace

std::unique_ptr<Contender> make_llvmpipe(const PeerScene& scene, int threads) {
    return std::make_unique<LlvmpipeContender>(scene, threads);
}

}  // namespace burnish::peers
