#include <fmt/format.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/multipass.hpp>
#include <burnish/program_place.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "machine/ranges.hpp"
#include "machine/value_passes.hpp"

namespace burnish {

namespace {

std::string part_name(RegisterPart part) {
    return fmt::format("{}.{}", register_name(part.reg), part.alpha ? "a" : "rgb");
}

bool is_texture(Register reg) {
    return reg >= Register::tex0 && reg <= Register::tex15;
}

int unit_of(Register reg) {
    return static_cast<int>(reg) - static_cast<int>(Register::tex0);
}

/// A part of a register that is read, and how.
struct Read {
    RegisterPart part;
    bool drops_negatives = true;
    bool implicit = false;  ///< by the machine itself: a mux or the colour sum
};

Read read_of(const Input& input) {
    const bool is_signed =
        input.mapping == Mapping::signed_identity || input.mapping == Mapping::signed_negate;
    return {part_of(input), !is_signed};
}

template <class F>
void for_each_read(const Portion& p, F&& f) {
    if (!p.writes()) return;
    const bool third = p.third_out != Register::discard;
    if (third || p.ab_out != Register::discard) {
        f(read_of(p.a));
        f(read_of(p.b));
    }
    if (third || p.cd_out != Register::discard) {
        f(read_of(p.c));
        f(read_of(p.d));
    }
    if (third && p.third == Third::mux) f(Read{{Register::spare0, true}, true, true});
}

template <class F>
void for_each_read(const GeneralStage& stage, F&& f) {
    for_each_read(stage.rgb, f);
    for_each_read(stage.alpha, f);
}

template <class F>
void for_each_read(const FinalCombiner& c, F&& f) {
    bool product = false, sum = false;
    for (const Input* input : {&c.a, &c.b, &c.c, &c.d, &c.g}) {
        product |= input->reg == Register::final_product;
        sum |= input->reg == Register::color_sum;
        f(read_of(*input));
    }
    if (product) {
        f(read_of(c.e));
        f(read_of(c.f));
    }
    if (sum) {
        f(Read{{Register::spare0, false}, true, true});
        f(Read{{Register::col1, false}, true, true});
    }
}

std::vector<RegisterPart> parts_written(const GeneralStage& stage) {
    std::vector<RegisterPart> parts;
    const auto add = [&](Register out, bool alpha) {
        if (out != Register::discard) parts.push_back({out, alpha});
    };
    for (const Portion* p : {&stage.rgb, &stage.alpha}) {
        for (const Register out : {p->ab_out, p->cd_out, p->third_out}) add(out, p == &stage.alpha);
    }
    if (stage.rgb.ab_blue_to_alpha) add(stage.rgb.ab_out, true);
    if (stage.rgb.cd_blue_to_alpha) add(stage.rgb.cd_out, true);
    return parts;
}

/// What earlier passes left: part of a register -> the pass whose frame holds it.
using Frames = std::map<RegisterPart, int>;

/// Looks for cuts between stages, the later ones first, with a step back where the rest cannot be
/// done.
class Splitter {
  public:
    Splitter(const CombinerProgram& program, const Machine& machine,
             std::span<const UnitTexels> units, bool fixed)
        : m_program(program),
          m_machine(machine),
          m_units(units),
          m_fixed(fixed),
          m_stages(static_cast<int>(program.stages.size())),
          m_ranges(register_ranges(program, machine, units)) {}

    bool split() { return continue_at(0, {}); }
    std::vector<ProgramPass> take() { return std::move(m_passes); }
    [[nodiscard]] const std::string& obstacle() const { return m_obstacle; }
    /// The general stage that it stands at, where it is one.
    [[nodiscard]] std::optional<std::size_t> obstacle_stage() const {
        if (m_obstacle_stage < 0 || m_obstacle_stage >= m_stages) return std::nullopt;
        return static_cast<std::size_t>(m_obstacle_stage);
    }

  private:
    /// Passes for stages `first` and later and the final combiner; false where there are none.
    bool continue_at(int first, const Frames& frames) {
        const int last = std::min(m_stages, first + m_machine.general_stages);
        if (last == m_stages && add_pass(first, m_stages, m_program.final_combiner, frames))
            return true;
        for (int end = std::min(last, m_stages - 1); end > first; --end) {
            const std::size_t before = m_passes.size();
            Frames left = frames;
            if (write_frames(first, end, frames, left) && continue_at(end, left)) return true;
            m_passes.resize(before);
        }
        return false;
    }

    bool fail(int stage, const std::string& what) {
        // Of all attempts, the one that came farthest says most.
        if (stage >= m_obstacle_stage) {
            m_obstacle_stage = stage;
            m_obstacle = stage < m_stages ? fmt::format("stage {}: {}", stage, what) : what;
        }
        return false;
    }

    /// Every part that is written before stage `end` and read from there on, as first read. False
    /// where a frame cannot hold one.
    bool find_live(int first, int end, std::set<RegisterPart>& live) {
        std::set<RegisterPart> written, replaced;
        for (int s = first; s < end; ++s) {
            for (const RegisterPart part : parts_written(stage(s))) written.insert(part);
        }
        bool possible = true;
        const auto look = [&](int s, const Read& read) {
            const bool here = written.count(read.part) != 0 && replaced.count(read.part) == 0;
            if (!here || !possible) return;
            const CodeRange range = m_ranges[static_cast<std::size_t>(end)][read.part];
            const std::string name = part_name(read.part);
            if (read.implicit) {
                possible =
                    fail(s, fmt::format("{} is read by {}, where no texture can stand for it", name,
                                        s < m_stages ? "mux()" : "color_sum"));
            } else if (range.low < 0 && !read.drops_negatives) {
                possible =
                    fail(s, fmt::format("{} may be {} / 255 and is read with its sign, which "
                                        "an 8-bit frame cannot hold",
                                        name, range.low));
            }
            live.insert(read.part);
        };
        for (int s = end; s < m_stages; ++s) {
            for_each_read(stage(s), [&](const Read& read) { look(s, read); });
            for (const RegisterPart part : parts_written(stage(s))) replaced.insert(part);
        }
        for_each_read(m_program.final_combiner, [&](const Read& read) { look(m_stages, read); });
        return possible;
    }

    /// Passes that run stages `first` .. `end` - 1, one for each frame that the rest needs.
    bool write_frames(int first, int end, const Frames& frames, Frames& left) {
        std::set<RegisterPart> live;
        if (!find_live(first, end, live)) return false;
        for (int s = first; s < end; ++s) {
            for (const RegisterPart part : parts_written(stage(s))) left.erase(part);
        }
        std::vector<Register> colors, alphas;
        for (const RegisterPart part : live) (part.alpha ? alphas : colors).push_back(part.reg);
        if (live.empty()) colors.push_back(Register::zero);  // the stages do nothing that counts
        for (std::size_t i = 0; i < std::max(colors.size(), alphas.size()); ++i) {
            FinalCombiner keep;
            if (i < colors.size()) keep.d.reg = colors[i];
            if (i < alphas.size()) keep.g.reg = alphas[i];
            if (!add_pass(first, end, keep, frames)) return false;
            const int pass = static_cast<int>(m_passes.size()) - 1;
            if (i < colors.size()) left[{colors[i], false}] = pass;
            if (i < alphas.size()) left[{alphas[i], true}] = pass;
        }
        return true;
    }

    [[nodiscard]] const GeneralStage& stage(int s) const {
        return m_program.stages[static_cast<std::size_t>(s)];
    }

    /// Units for whatever the stages and the final combiner read that they have not written.
    struct Places {
        std::vector<PassUnit> units;
        std::map<int, int> of_unit, of_frame;  ///< -> unit of the pass
    };

    /// Calls f(stage, read, replaced) for every read of a pass; `replaced`: the pass itself wrote
    /// that part before.
    template <class F>
    void for_each_read_of_pass(int first, int end, const FinalCombiner& final_combiner, F&& f) {
        std::set<RegisterPart> replaced;
        for (int s = first; s < end; ++s) {
            for_each_read(stage(s),
                          [&](const Read& read) { f(s, read, replaced.count(read.part) != 0); });
            for (const RegisterPart part : parts_written(stage(s))) replaced.insert(part);
        }
        for_each_read(final_combiner,
                      [&](const Read& read) { f(end, read, replaced.count(read.part) != 0); });
    }

    bool find_places(int first, int end, const FinalCombiner& final_combiner, const Frames& frames,
                     Places& places) {
        std::set<int> own, read_frames, taken;
        bool needs_unit_0 = false;
        for_each_read_of_pass(first, end, final_combiner,
                              [&](int, const Read& read, bool replaced) {
                                  if (replaced) return;
                                  const auto frame = frames.find(read.part);
                                  if (frame != frames.end()) {
                                      read_frames.insert(frame->second);
                                  } else if (is_texture(read.part.reg)) {
                                      own.insert(unit_of(read.part.reg));
                                  } else if (read.part == RegisterPart{Register::spare0, true}) {
                                      needs_unit_0 = true;  // it starts as the alpha of unit 0
                                  }
                              });
        if (needs_unit_0) own.insert(0);
        const auto material_units = static_cast<int>(m_units.size());
        for (int unit = 0; m_fixed && unit < material_units; ++unit) {
            if (m_units[static_cast<std::size_t>(unit)] != UnitTexels::none) own.insert(unit);
        }
        // Registers that the pass writes are its own; a unit under such a name would be lost.
        for (int s = first; s < end; ++s) {
            for (const RegisterPart part : parts_written(stage(s))) {
                if (is_texture(part.reg)) taken.insert(unit_of(part.reg));
            }
        }
        const int count = m_machine.texture_units;
        places.units.assign(static_cast<std::size_t>(count), PassUnit{});
        const auto is_free = [&](int unit) {
            return places.units[static_cast<std::size_t>(unit)] == PassUnit{} &&
                   taken.count(unit) == 0 && own.count(unit) == 0;
        };
        const auto free_unit = [&] {
            int unit = count - 1;
            while (unit >= 0 && !is_free(unit)) --unit;
            return unit;
        };
        const auto short_of = [&] {
            return fail(first, fmt::format("{} textures and {} frames of earlier passes are read, "
                                           "with {} texture units",
                                           own.size(), read_frames.size(), count));
        };
        for (const int unit : own) {
            const bool keeps = unit < count;
            const int place = keeps ? unit : m_fixed ? -1 : free_unit();
            if (place < 0) return short_of();
            places.units[static_cast<std::size_t>(place)].material_unit = unit;
            places.of_unit[unit] = place;
        }
        for (const int frame : read_frames) {
            const int place = free_unit();
            if (place < 0) return short_of();
            places.units[static_cast<std::size_t>(place)].frame = frame;
            places.of_frame[frame] = place;
        }
        return true;
    }

    /// Constants where the machine has one pair for all stages: those of the pass, if its stages
    /// agree.
    bool set_constants(int first, int end, const FinalCombiner& final_combiner,
                       CombinerProgram& pass) {
        if (m_machine.stage_constants) return true;
        std::optional<glm::vec4> used[2];
        bool agree = true;
        for_each_read_of_pass(
            first, end, final_combiner, [&](int s, const Read& read, bool /*replaced*/) {
                if (read.part.reg != Register::const0 && read.part.reg != Register::const1) return;
                const bool is_one = read.part.reg == Register::const1;
                const std::optional<glm::vec4>* own = nullptr;
                if (s < end) own = is_one ? &stage(s).const1 : &stage(s).const0;
                const glm::vec4 global = is_one ? m_program.const1 : m_program.const0;
                const glm::vec4 value = own != nullptr && *own ? **own : global;
                std::optional<glm::vec4>& all = used[is_one ? 1 : 0];
                if (all && *all != value) agree = false;
                all = value;
            });
        if (!agree) {
            return fail(first,
                        "stages with different constants stand in one pass, and the machine "
                        "has one pair");
        }
        pass.const0 = used[0].value_or(glm::vec4(0.0F));
        pass.const1 = used[1].value_or(glm::vec4(0.0F));
        for (GeneralStage& s : pass.stages) {
            s.const0.reset();
            s.const1.reset();
        }
        return true;
    }

    /// Stages `first` .. `end` - 1 and the final combiner, with their reads turned to the units.
    bool add_pass(int first, int end, const FinalCombiner& final_combiner, const Frames& frames) {
        Places places;
        if (!find_places(first, end, final_combiner, frames, places)) return false;
        ProgramPass pass{m_program, places.units};
        pass.program.stages.assign(m_program.stages.begin() + first,
                                   m_program.stages.begin() + end);
        pass.program.final_combiner = final_combiner;
        if (!set_constants(first, end, final_combiner, pass.program)) return false;

        std::set<RegisterPart> replaced;
        const auto turn = [&](Input& input) {
            const RegisterPart part = part_of(input);
            if (replaced.count(part) != 0) return;
            if (const auto frame = frames.find(part); frame != frames.end()) {
                // A dead input may name a frame that nothing of the pass reads.
                const auto place = places.of_frame.find(frame->second);
                input.reg = place == places.of_frame.end() ? Register::zero : tex(place->second);
            } else if (is_texture(input.reg)) {
                const auto place = places.of_unit.find(unit_of(input.reg));
                input.reg = place == places.of_unit.end() ? Register::zero : tex(place->second);
            }
        };
        for (GeneralStage& s : pass.program.stages) {
            for (Portion* p : {&s.rgb, &s.alpha}) {
                for (Input* input : {&p->a, &p->b, &p->c, &p->d}) turn(*input);
            }
            for (const RegisterPart part : parts_written(s)) replaced.insert(part);
        }
        FinalCombiner& f = pass.program.final_combiner;
        for (Input* input : {&f.a, &f.b, &f.c, &f.d, &f.e, &f.f, &f.g}) turn(*input);
        if (const auto wrong = why_invalid(pass.program)) return fail(first, *wrong);
        m_passes.push_back(std::move(pass));
        return true;
    }

    /// What else the machine lacks, registers tex2 and later as places for results, say.
    [[nodiscard]] std::optional<std::string> why_invalid(const CombinerProgram& program) const {
        try {
            program.validate(m_machine);
        } catch (const Error& error) {
            return error.what();
        }
        return std::nullopt;
    }

    const CombinerProgram& m_program;
    const Machine& m_machine;
    std::span<const UnitTexels> m_units;
    bool m_fixed;
    int m_stages;
    std::vector<RegisterRanges> m_ranges;  ///< element s: before stage s
    std::vector<ProgramPass> m_passes;
    int m_obstacle_stage = -1;
    std::string m_obstacle = "no stage can be run alone";
};

}  // namespace

Machine with_room(const Machine& machine) {
    Machine roomy = machine;
    roomy.general_stages = 16;
    roomy.texture_units = 16;
    roomy.stage_constants = true;
    roomy.stage_fetches |= machine.texture_operations != TextureOperations::plain;
    return roomy;
}

std::vector<ProgramPass> split_into_passes(const CombinerProgram& program, const Machine& machine,
                                           std::span<const UnitTexels> units, bool fixed) {
    program.validate(with_room(machine));
    if (machine.numbers != NumberModel::nine_bit)
        throw Error(ErrorCode::bad_program,
                    fmt::format("cannot be split into passes: an 8-bit frame does not hold the "
                                "registers of machine '{}'",
                                machine.name));
    const bool fetches =
        std::any_of(program.stages.begin(), program.stages.end(),
                    [](const GeneralStage& stage) { return !stage.fetches.empty(); });
    std::string obstacle;
    std::optional<std::size_t> stage;
    if (!fetches) {
        Splitter splitter(program, machine, units, fixed);
        if (splitter.split()) return splitter.take();
        obstacle = splitter.obstacle();
        stage = splitter.obstacle_stage();
    }
    if (!fixed) {
        std::string why;
        if (auto passes = passes_by_value(program, machine, units, why)) return *std::move(passes);
        obstacle += (obstacle.empty() ? "" : "; value by value: ") + why;
    }
    const std::string message =
        fmt::format("cannot be split into passes for machine '{}': {}", machine.name, obstacle);
    if (stage) throw ProgramFault({ProgramPlace::Part::stage, *stage}, message);
    throw Error(ErrorCode::bad_program, message);
}

}  // namespace burnish
