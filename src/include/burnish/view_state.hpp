#pragma once

#include <array>
#include <burnish/machine.hpp>
#include <burnish/scene.hpp>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

namespace burnish {

/// What somebody changed of a material while looking at it; what is not there is as loaded.
struct MaterialEdit {
    std::string name;  ///< of the material in its scene
    std::optional<Model> model = {};
    std::optional<glm::vec3> kd = {}, ks = {};        ///< [0, 1]
    std::optional<float> alpha_x = {}, alpha_y = {};  ///< (0, 1], instead of maps
    std::optional<float> exponent = {};               ///< > 0, likewise
    std::optional<std::string> combiners = {};  ///< the program as text, of a pipeline or a model
    /// Of a model: the text of what it was compiled to when `combiners` was made of it.
    std::optional<std::string> compiled = {};

    friend bool operator==(const MaterialEdit&, const MaterialEdit&) = default;
};

/// Everything that decides what the window of `burnish view` shows of its input: what one run
/// saves, another one shows again, bit for bit.
struct ViewState {
    std::filesystem::path input;
    int width = 1280, height = 720;          ///< pixels, 1 .. Framebuffer::kMaxSize
    Camera camera;                           ///< by vectors, without matrices
    std::optional<glm::vec3> light;          ///< towards the first light, instead of the scene's
    std::string machine;                     ///< a profile; empty: the scene's machine
    std::optional<std::string> half_vector;  ///< of choose_half_vector
    std::optional<FilterOrder> filter_order;
    std::string bits;  ///< of every stage, as `burnish trace --bits` has them; empty: the machine's
    std::optional<MaterialMipmaps> mipmaps;  ///< of every reflectance model
    bool split = false;                      ///< geforce256 | nv2a | ideal | double side by side
    std::array<float, 3> lines{0.25F, 0.5F, 0.75F};  ///< between them: ascending, 0 .. 1 of width
    bool heat_map = false;                           ///< |picture - double| instead of the picture
    float gain = 8.0F;                               ///< of the heat map, > 0
    std::optional<glm::ivec2> pixel;                 ///< that is traced
    std::vector<MaterialEdit> materials;

    friend bool operator==(const ViewState&, const ViewState&) = default;
};

/// The state as TOML (docs/view.md), which load_view_state turns into the same state again.
std::string view_state_text(const ViewState& state);

}  // namespace burnish
