#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/machine.hpp>

/// Programs for the register-combiner machine, as data and through a small typed builder.
/// Semantics: NV_register_combiners 1.7 and the measured behaviour of the NV2A; docs/numbers.md
/// says what each number format does.
namespace burnish {

/// Registers by their names in the text syntax. `tex0` + i is texture unit i.
enum class Register : std::uint8_t {
    zero,
    const0,
    const1,
    fog,  ///< alpha only in the final combiner
    col0,
    col1,
    tex0,
    tex1,
    tex2,
    tex3,
    tex4,
    tex5,
    tex6,
    tex7,
    tex8,
    tex9,
    tex10,
    tex11,
    tex12,
    tex13,
    tex14,
    tex15,
    spare0,
    spare1,
    color_sum,      ///< spare0 + col1; inputs B, C, D of the final combiner
    final_product,  ///< E * F; inputs A .. D of the final combiner
    discard,        ///< write only: the result is dropped
};

/// Texture register of unit 0 .. 15.
constexpr Register tex(int unit) {
    return static_cast<Register>(static_cast<int>(Register::tex0) + unit);
}

/// The name of `reg` in the text syntax; "unknown register" outside the enumeration.
std::string_view register_name(Register reg);

/// What an input does to the register component e in [-1, 1] that it reads.
enum class Mapping : std::uint8_t {
    unsigned_identity,  ///< max(0, e)
    unsigned_invert,    ///< 1 - clamp(e, 0, 1)
    expand,             ///< 2 max(0, e) - 1
    expand_negate,      ///< 1 - 2 max(0, e)
    half_bias,          ///< max(0, e) - 1/2
    half_bias_negate,   ///< 1/2 - max(0, e)
    signed_identity,    ///< e
    signed_negate,      ///< -e
};
inline constexpr int kMappingCount = 8;

/// Which components of a register an input reads.
enum class Component : std::uint8_t {
    rgb,    ///< each its own; rgb portions and final A .. F
    alpha,  ///< alpha in every component; anywhere
    blue,   ///< blue; alpha portions and final G
};

struct Input {
    Register reg = Register::zero;
    Mapping mapping = Mapping::signed_identity;
    Component component = Component::rgb;

    friend bool operator==(const Input&, const Input&) = default;
};

enum class Product : std::uint8_t {
    multiply,  ///< component by component
    dot,       ///< r, g, b summed, the sum in each of them; rgb portions only
};

/// The third output of a portion, from the products before scale and bias.
enum class Third : std::uint8_t {
    sum,  ///< AB + CD
    mux,  ///< CD where CombinerProgram::mux_bit of spare0.alpha at stage input is set, else AB
};

enum class Scale : std::uint8_t { one, two, four, half };

/// One portion of a general stage: out = clamp((x + bias) * scale, -1, 1) for x = AB, CD, third.
/// The portion does nothing while all three outputs are `discard`.
struct Portion {
    Input a, b, c, d;
    Product ab_product = Product::multiply;
    Product cd_product = Product::multiply;
    Third third = Third::sum;
    Register ab_out = Register::discard;
    Register cd_out = Register::discard;
    Register third_out = Register::discard;
    Scale scale = Scale::one;
    bool bias_minus_half = false;  ///< only with scale one and two
    bool wide = false;  ///< wide numbers only: saturate at the register's range instead of [-1, 1]
    /// rgb portions only, a switch of the hardware that OpenGL never had: the blue of the output
    /// goes to the alpha of its register, too, which the alpha portion then may not write.
    bool ab_blue_to_alpha = false, cd_blue_to_alpha = false;

    [[nodiscard]] bool writes() const {
        return ab_out != Register::discard || cd_out != Register::discard ||
               third_out != Register::discard;
    }

    friend bool operator==(const Portion&, const Portion&) = default;
};

enum class FetchTarget : std::uint8_t {
    table_1d,
    table_2d,
    table_3d,
    table_cube_map,
    table_rectangle,  ///< coordinates in texels
};

/// How many coordinates a fetch from `target` takes: 1, 2 or 3.
int coordinate_count(FetchTarget target);

/// A register component as a texture coordinate.
struct FetchCoordinate {
    Register reg = Register::zero;
    std::uint8_t component = 0;  ///< 0 .. 3: r, g, b, a
    bool expand = false;         ///< 2 max(0, e) - 1 instead of e

    friend bool operator==(const FetchCoordinate&, const FetchCoordinate&) = default;
};

/// A texture fetch between general stages. The register that it writes names the unit whose texture
/// is read.
struct StageFetch {
    Register destination = Register::tex0;
    FetchTarget target = FetchTarget::table_2d;
    /// The first coordinate_count(target) of them count, the others stay as they are here.
    std::array<FetchCoordinate, 3> coordinates{};

    friend bool operator==(const StageFetch&, const StageFetch&) = default;
};

/// Both portions read the registers as they were before the stage, that is after its fetches.
struct GeneralStage {
    Portion rgb;
    Portion alpha;
    std::optional<glm::vec4> const0;  ///< this stage's own constants, if the machine has them
    std::optional<glm::vec4> const1;
    /// Before the stage, one after the other: a fetch may read what an earlier one delivered. Each
    /// has a destination of its own. Constants are this stage's.
    std::vector<StageFetch> fetches;

    friend bool operator==(const GeneralStage&, const GeneralStage&) = default;
};

/// A stage that does nothing, as the text syntax and ProgramBuilder::stage() have it: every input
/// is zero, alpha's in the alpha portion.
GeneralStage idle_stage();

/// rgb = min(1, A*B + (1 - A)*C + D), alpha = G, for unsigned mappings only.
struct FinalCombiner {
    Input a{Register::zero, Mapping::unsigned_identity, Component::rgb};
    Input b = a, c = a, d = a, e = a, f = a;
    Input g{Register::zero, Mapping::unsigned_identity, Component::alpha};
    bool clamp_color_sum = false;
    /// Switches of the hardware that OpenGL never had: 1 - x of an operand of the colour sum.
    bool complement_spare0 = false, complement_secondary = false;

    friend bool operator==(const FinalCombiner&, const FinalCombiner&) = default;
};

/// The bit of the 8-bit spare0.alpha that a mux tests; CD where it is set.
enum class MuxBit : std::uint8_t {
    msb,  ///< alpha >= 1/2: what OpenGL asks for
    lsb,  ///< nine-bit numbers only
};

struct CombinerProgram {
    std::vector<GeneralStage> stages;
    FinalCombiner final_combiner;
    glm::vec4 const0{0.0F};  ///< clamped to [0, 1]
    glm::vec4 const1{0.0F};
    glm::vec4 fog{0.0F};
    MuxBit mux_bit = MuxBit::msb;

    /// Throws Error{bad_program}: "stage 3, rgb: ..." for whatever `machine` cannot run.
    void validate(const Machine& machine) const;

    friend bool operator==(const CombinerProgram&, const CombinerProgram&) = default;
};

/// Short names for building programs in C++:
///
///     ProgramBuilder p;
///     p.stage().rgb().ab(dot(expand(tex(0)), expand(Register::col0)), Register::spare0);
///     p.lerp(raw(Register::spare0), ...);
namespace combine {

struct ProductExpr {
    Input x, y;
    Product kind;
};

constexpr Input in(Register r) {
    return {r, Mapping::signed_identity, Component::rgb};
}
constexpr Input raw(Register r) {
    return {r, Mapping::unsigned_identity, Component::rgb};
}
constexpr Input expand(Register r) {
    return {r, Mapping::expand, Component::rgb};
}
constexpr Input half_bias(Register r) {
    return {r, Mapping::half_bias, Component::rgb};
}
constexpr Input invert(Register r) {
    return {r, Mapping::unsigned_invert, Component::rgb};
}
constexpr Input one() {
    return invert(Register::zero);
}
constexpr Input alpha(Input i) {
    return {i.reg, i.mapping, Component::alpha};
}
constexpr Input blue(Input i) {
    return {i.reg, i.mapping, Component::blue};
}
constexpr ProductExpr mul(Input x, Input y) {
    return {x, y, Product::multiply};
}
constexpr ProductExpr dot(Input x, Input y) {
    return {x, y, Product::dot};
}

}  // namespace combine

/// Fills one portion; every call returns the builder again.
class PortionBuilder {
  public:
    explicit PortionBuilder(Portion& portion) : m_portion(&portion) {}
    PortionBuilder& ab(const combine::ProductExpr& p, Register out = Register::discard);
    PortionBuilder& cd(const combine::ProductExpr& p, Register out = Register::discard);
    PortionBuilder& sum(Register out);
    PortionBuilder& mux(Register out);
    PortionBuilder& scale(Scale s);
    PortionBuilder& bias();
    PortionBuilder& wide();

  private:
    Portion* m_portion;
};

/// Builds a CombinerProgram stage by stage. `build()` hands it over; validation is the machine's.
class ProgramBuilder {
  public:
    /// Opens the next general stage.
    ProgramBuilder& stage();
    /// Portions of the open stage; at least one stage() must have come before.
    PortionBuilder rgb();
    PortionBuilder alpha();
    /// rgb = A*B + (1 - A)*C + D
    ProgramBuilder& lerp(Input a, Input b, Input c, Input d);
    /// final_product = E * F
    ProgramBuilder& product(Input e, Input f);
    ProgramBuilder& out_alpha(Input g);
    ProgramBuilder& constants(const glm::vec4& const0, const glm::vec4& const1);
    [[nodiscard]] CombinerProgram build() const { return m_program; }

  private:
    CombinerProgram m_program;
};

}  // namespace burnish
