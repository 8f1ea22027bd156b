#include "machine/value_passes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <burnish/error.hpp>
#include <burnish/program_text.hpp>
#include <map>
#include <set>

#include "machine/ranges.hpp"

namespace burnish {

namespace {

constexpr int kFetch = 3;            // as an output, after AB, CD and the third
constexpr int kSomeFrame = 1 << 20;  // one that is still to be left

std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}
bool is_texture(Register reg) {
    return reg >= Register::tex0 && reg <= Register::tex15;
}
int unit_of(Register reg) {
    return static_cast<int>(reg) - static_cast<int>(Register::tex0);
}

/// What is read: what an operation made, or a register as it is at the start.
struct Reference {
    RegisterPart part{Register::zero, false};
    int value = -1;
};

/// What an operation makes: an output of a portion, or a fetch.
struct Value {
    int stage = 0;
    bool in_alpha = false;
    int output = 0;
    int fetch = -1;  ///< number in its stage
    std::vector<Reference> reads;
    bool is_signed = false;
    int frame = -1;        ///< the pass that left it
    int coordinates = -1;  ///< of a fetch: the pass that left them
};

/// What an input of a pass's final combiner reads.
struct Wanted {
    Input FinalCombiner::*input;
    Reference from;
};

/// A table that a frame addresses.
struct TableRead {
    int frame, unit;
    int value;  ///< the fetch
    friend auto operator<=>(const TableRead&, const TableRead&) = default;
};

/// Everything that some values need of a pass.
struct Slice {
    std::set<int> values;  ///< to be computed
    std::set<int> own;     ///< units of the material
    std::set<int> frames;
    std::set<int> framed;  ///< the values that are read from them
    std::set<TableRead> tables;
    std::set<int> stages;
    int missing_fetch = -1;  ///< a fetch whose coordinates no frame holds yet

    /// What there is to do: units first.
    [[nodiscard]] std::array<std::size_t, 3> size() const {
        return {static_cast<std::size_t>(units()), stages.size(), values.size()};
    }
    [[nodiscard]] int units() const {
        return static_cast<int>(own.size() + frames.size() + tables.size());
    }
};

template <class F>
void for_each_input(const Portion& p, int output, F&& f) {
    if (output != 1) {
        f(p.a);
        f(p.b);
    }
    if (output != 0) {
        f(p.c);
        f(p.d);
    }
}

Register output_register(const Portion& p, int output) {
    return output == 0 ? p.ab_out : output == 1 ? p.cd_out : p.third_out;
}

/// What a coordinate of a fetch reads, as an input of the final combiner.
Input coordinate_input(const FetchCoordinate& from) {
    const Component component = from.component == 3   ? Component::alpha
                                : from.component == 2 ? Component::blue
                                                      : Component::rgb;
    return {from.reg, Mapping::unsigned_identity, component};
}

class ValueSplitter {
  public:
    ValueSplitter(const CombinerProgram& program, const Machine& machine,
                  std::span<const UnitTexels> units)
        : m_program(program), m_machine(machine) {
        number_values(register_ranges(program, machine, units));
    }

    bool split() {
        if (m_switches) return fail("it has a mux, a colour sum or blue in alpha");
        const FinalCombiner& f = m_program.final_combiner;
        std::vector<Wanted> wanted;
        for (const auto input : kFinalInputs)
            wanted.push_back({input, reference(part_of(f.*input), m_after)});
        return make_room(f, wanted) && add_pass(f, wanted);
    }

    std::vector<ProgramPass> take() { return std::move(m_passes); }
    [[nodiscard]] const std::string& obstacle() const { return m_obstacle; }

  private:
    [[nodiscard]] int m_stages() const { return static_cast<int>(m_program.stages.size()); }
    [[nodiscard]] const GeneralStage& stage(int s) const { return m_program.stages[at(s)]; }
    [[nodiscard]] const Portion& portion(const Value& v) const {
        return v.in_alpha ? stage(v.stage).alpha : stage(v.stage).rgb;
    }

    bool fail(std::string why) {
        m_obstacle = std::move(why);
        return false;
    }

    static constexpr std::array kFinalInputs{
        &FinalCombiner::a, &FinalCombiner::b, &FinalCombiner::c, &FinalCombiner::d,
        &FinalCombiner::e, &FinalCombiner::f, &FinalCombiner::g};

    Reference reference(RegisterPart part, const std::map<RegisterPart, int>& current) const {
        const auto value = current.find(part);
        return {part, value == current.end() ? -1 : value->second};
    }

    void number_values(const std::vector<RegisterRanges>& ranges) {
        std::map<RegisterPart, int> current;
        for (int s = 0; s < m_stages(); ++s) {
            const GeneralStage& general = stage(s);
            for (std::size_t k = 0; k < general.fetches.size(); ++k) {
                const StageFetch& fetch = general.fetches[k];
                Value v{.stage = s, .output = kFetch, .fetch = static_cast<int>(k), .reads = {}};
                for (int c = 0; c < coordinate_count(fetch.target); ++c)
                    v.reads.push_back(
                        reference(part_of(coordinate_input(fetch.coordinates[at(c)])), current));
                const int id = static_cast<int>(m_values.size());
                m_values.push_back(std::move(v));
                current[{fetch.destination, false}] = current[{fetch.destination, true}] = id;
            }
            m_before.push_back(current);
            for (const bool in_alpha : {false, true}) {
                const Portion& p = in_alpha ? general.alpha : general.rgb;
                m_switches |= p.writes() &&
                              (p.third == Third::mux || p.ab_blue_to_alpha || p.cd_blue_to_alpha);
                for (int output = 0; output < kFetch; ++output) {
                    const Register to = output_register(p, output);
                    if (to == Register::discard) continue;
                    Value v{.stage = s, .in_alpha = in_alpha, .output = output, .reads = {}};
                    for_each_input(p, output, [&](const Input& i) {
                        v.reads.push_back(reference(part_of(i), m_before.back()));
                    });
                    const RegisterPart part{to, in_alpha};
                    v.is_signed = ranges[at(s + 1)][part].low < 0;
                    current[part] = static_cast<int>(m_values.size());
                    m_values.push_back(std::move(v));
                }
            }
        }
        m_after = current;
        const FinalCombiner& f = m_program.final_combiner;
        for (const auto input : kFinalInputs) m_switches |= (f.*input).reg == Register::color_sum;
    }

    /// @param again  a value that is to be computed although a frame may hold it
    Slice slice_of(const std::vector<Wanted>& wanted, int again = -1) const {
        Slice slice;
        const auto visit = [&](const auto& self, const Reference& r) -> void {
            if (r.value < 0) {
                if (is_texture(r.part.reg)) slice.own.insert(unit_of(r.part.reg));
                // It starts as the alpha of unit 0.
                if (r.part == RegisterPart{Register::spare0, true}) slice.own.insert(0);
                return;
            }
            const Value& v = m_values[at(r.value)];
            if (v.frame >= 0 && r.value != again) {
                slice.frames.insert(v.frame);
                slice.framed.insert(r.value);
                return;
            }
            if (v.output == kFetch) {
                if (v.coordinates < 0) {
                    // The deepest one first: its coordinates need no other missing fetch.
                    if (slice.missing_fetch < 0 || r.value < slice.missing_fetch)
                        slice.missing_fetch = r.value;
                    return;
                }
                slice.frames.insert(v.coordinates);
                slice.tables.insert({v.coordinates, unit_of(r.part.reg), r.value});
                return;
            }
            if (!slice.values.insert(r.value).second) return;
            slice.stages.insert(v.stage);
            for (const Reference& read : v.reads) self(self, read);
        };
        for (const Wanted& w : wanted) visit(visit, w.from);
        return slice;
    }

    [[nodiscard]] bool fits(const Slice& slice) const {
        return slice.missing_fetch < 0 && slice.units() <= m_machine.texture_units &&
               static_cast<int>(slice.stages.size()) <= m_machine.general_stages;
    }

    /// Frames for what is wanted, until one pass computes it.
    bool make_room(const FinalCombiner& final_combiner, const std::vector<Wanted>& wanted) {
        for (;;) {
            const Slice slice = slice_of(wanted);
            if (slice.missing_fetch >= 0) {
                if (!make_coordinates(slice.missing_fetch)) return false;
                continue;
            }
            if (fits(slice) && constants_agree(slice, final_combiner, wanted)) return true;
            // Of all values that a pass can leave, the one that leaves least to do.
            int best = -1;
            auto least = slice.size();
            const auto consider = [&](int id) {
                Value& v = m_values[at(id)];
                if (v.is_signed || v.frame >= 0) return;
                const Slice own = slice_of({{&FinalCombiner::d, {part_of_value(v), id}}});
                if (!fits(own) || !constants_agree(own, {}, {})) return;
                v.frame = kSomeFrame;
                const Slice rest = slice_of(wanted);
                v.frame = -1;
                if (rest.size() < least) {
                    least = rest.size();
                    best = id;
                }
            };
            for (const int id : slice.values) consider(id);
            for (const TableRead& table : slice.tables) consider(table.value);
            if (best < 0 && share_frame(slice)) continue;
            if (best < 0) {
                return fail(fmt::format(
                    "{} textures, {} tables, {} frames and {} stages are needed at once, with {} "
                    "texture units and {} general stages, and no part of it is without sign and "
                    "fits a pass",
                    slice.own.size(), slice.tables.size(), slice.frames.size(), slice.stages.size(),
                    m_machine.texture_units, m_machine.general_stages));
            }
            if (!leave(best)) return false;
        }
    }

    [[nodiscard]] RegisterPart part_of_value(const Value& v) const {
        if (v.output == kFetch) return {stage(v.stage).fetches[at(v.fetch)].destination, false};
        return {output_register(portion(v), v.output), v.in_alpha};
    }

    /// A pass that leaves value `id`.
    bool leave(int id) {
        Value& v = m_values[at(id)];
        const RegisterPart part = part_of_value(v);
        const auto input = part.alpha ? &FinalCombiner::g : &FinalCombiner::d;
        FinalCombiner keep;
        (keep.*input).reg = part.reg;
        if (!add_pass(keep, {{input, {part, id}}}, id)) return false;
        v.frame = static_cast<int>(m_passes.size()) - 1;
        return true;
    }

    /// Of a colour in one frame and a number in another's alpha, one frame. It is read as before.
    bool share_frame(const Slice& slice) {
        for (const int color : slice.framed) {
            for (const int number : slice.framed) {
                Value& c = m_values[at(color)];
                Value& n = m_values[at(number)];
                const RegisterPart rgb = part_of_value(c), alpha = part_of_value(n);
                if (rgb.alpha || !alpha.alpha || c.frame == n.frame || c.output == kFetch) continue;
                FinalCombiner keep;
                keep.d.reg = rgb.reg;
                keep.g.reg = alpha.reg;
                const std::vector<Wanted> both{{&FinalCombiner::d, {rgb, color}},
                                               {&FinalCombiner::g, {alpha, number}}};
                // Only frames of their own become superfluous.
                const auto alone = [&](int frame) {
                    return std::ranges::count_if(slice.framed, [&](int id) {
                               return m_values[at(id)].frame == frame;
                           }) == 1;
                };
                if (!alone(c.frame) || !alone(n.frame) || !add_pass(keep, both)) continue;
                c.frame = n.frame = static_cast<int>(m_passes.size()) - 1;
                return true;
            }
        }
        return false;
    }

    /// A pass that leaves the coordinates of a fetch: s in alpha, t in red.
    bool make_coordinates(int id) {
        const Value& v = m_values[at(id)];
        const StageFetch& fetch = stage(v.stage).fetches[at(v.fetch)];
        const int count = coordinate_count(fetch.target);
        const FetchCoordinate& first = fetch.coordinates[0];
        const FetchCoordinate& second = fetch.coordinates[1];
        if (count > 2 || fetch.target == FetchTarget::table_rectangle)
            return fail("a dependent read has two coordinates of 0 .. 1");
        if (first.expand || first.component < 2 ||
            (count == 2 && (second.expand || second.component % 3 != 0)))
            return fail(
                fmt::format("{}: a frame can bring blue or alpha to the first coordinate, "
                            "red or alpha to the second",
                            print_fetch(fetch)));
        FinalCombiner keep;
        std::vector<Wanted> wanted{{&FinalCombiner::g, v.reads[0]}};
        keep.g = coordinate_input(first);
        if (count == 2) {
            keep.d = coordinate_input(second);
            wanted.push_back({&FinalCombiner::d, v.reads[1]});
        }
        if (!make_room(keep, wanted) || !add_pass(keep, wanted)) return false;
        m_values[at(id)].coordinates = static_cast<int>(m_passes.size()) - 1;
        return true;
    }

    /// Units of a pass: what is read of the material, the frames and the tables behind them.
    struct Places {
        std::vector<PassUnit> units;
        std::map<int, int> own, frames;
        std::map<TableRead, int> tables;
    };

    bool find_places(const Slice& slice, Places& places) {
        const int count = m_machine.texture_units;
        places.units.assign(at(count), PassUnit{});
        const auto next = [&](int from, int step) {
            while (from >= 0 && from < count && places.units[at(from)] != PassUnit{}) from += step;
            return from >= 0 && from < count ? from : -1;
        };
        const auto no_unit = [&] { return fail("no texture unit is left"); };
        const bool needs_unit_0 = slice.own.contains(0);
        if (needs_unit_0) {
            places.units[0].material_unit = 0;
            places.own[0] = 0;
        }
        for (const TableRead& table : slice.tables) {
            const int place = next(count - 1, -1);
            if (place < 0) return no_unit();
            places.units[at(place)].material_unit = table.unit;
            places.units[at(place)].address = count;  // known below
            places.tables[table] = place;
        }
        for (const int frame : slice.frames) {
            const int place = next(0, 1);
            if (place < 0) return no_unit();
            places.units[at(place)].frame = frame;
            places.frames[frame] = place;
        }
        for (const int unit : slice.own) {
            if (unit == 0) continue;
            const int place = next(0, 1);
            if (place < 0) return no_unit();
            places.units[at(place)].material_unit = unit;
            places.own[unit] = place;
        }
        for (const auto& [table, place] : places.tables) {
            const int address = places.frames.at(table.frame);
            if (address > place) return fail("no unit before a table's is left for its frame");
            places.units[at(place)].address = address;
        }
        return true;
    }

    /// The pass that computes `wanted`; `again`: a value that a frame may hold already.
    bool add_pass(const FinalCombiner& final_combiner, const std::vector<Wanted>& wanted,
                  int again = -1) {
        const Slice slice = slice_of(wanted, again);
        Places places;
        if (!fits(slice)) return fail("a pass has no room");
        if (!find_places(slice, places)) return false;
        ProgramPass pass{m_program, places.units};
        pass.program.stages.clear();
        std::map<int, Register> results;
        /// Which register a pass has something in that it reads.
        const auto source = [&](const Reference& r) {
            if (r.value < 0) {
                if (!is_texture(r.part.reg)) return r.part.reg;
                const auto place = places.own.find(unit_of(r.part.reg));
                return place == places.own.end() ? Register::zero : tex(place->second);
            }
            if (slice.values.contains(r.value)) return results.at(r.value);
            const Value& v = m_values[at(r.value)];
            if (v.frame >= 0 && r.value != again) return tex(places.frames.at(v.frame));
            return tex(places.tables.at({v.coordinates, unit_of(r.part.reg), r.value}));
        };
        if (!allocate(slice, wanted, source, results)) return false;
        const auto turn = [&](Input& input, const Reference& r) { input.reg = source(r); };
        for (const int s : slice.stages) {
            GeneralStage made = idle_stage();
            made.const0 = stage(s).const0;
            made.const1 = stage(s).const1;
            for (const int id : slice.values) {
                const Value& v = m_values[at(id)];
                if (v.stage == s) copy_output(v, results.at(id), turn, made);
            }
            pass.program.stages.push_back(std::move(made));
        }
        pass.program.final_combiner = final_combiner;
        for (const Wanted& w : wanted) (pass.program.final_combiner.*w.input).reg = source(w.from);
        if (!set_constants(pass.program)) return false;
        try {
            pass.program.validate(m_machine);
        } catch (const Error& error) {
            return fail(error.what());
        }
        m_passes.push_back(std::move(pass));
        return true;
    }

    /// Registers for the results of a pass: halves of registers that nothing reads any more.
    template <class Source>
    bool allocate(const Slice& slice, const std::vector<Wanted>& wanted, const Source& source,
                  std::map<int, Register>& results) {
        constexpr int kEnd = 1000;
        // Until which stage something is read: results by their number, others by their place.
        std::map<int, int> result_until;
        std::map<RegisterPart, int> until;
        const auto read_at = [&](const Reference& r, int when) {
            if (r.value >= 0 && slice.values.contains(r.value)) {
                result_until[r.value] = std::max(result_until[r.value], when);
            } else {
                int& last = until[{source(r), r.part.alpha}];
                last = std::max(last, when);
            }
        };
        for (const int id : slice.values) {
            for (const Reference& r : m_values[at(id)].reads) read_at(r, m_values[at(id)].stage);
        }
        for (const Wanted& w : wanted) read_at(w.from, kEnd);
        std::map<RegisterPart, int> written;  // by the stage that is looked at
        for (const int s : slice.stages) {
            written.clear();
            for (const int id : slice.values) {
                const Value& v = m_values[at(id)];
                if (v.stage != s) continue;
                const auto reg = free_register(v.in_alpha, s, until, written);
                if (!reg) return fail("no register is left for a result");
                results[id] = *reg;
                written[{*reg, v.in_alpha}] = 1;
                until[{*reg, v.in_alpha}] = std::max(result_until[id], s + 1);
            }
        }
        return true;
    }

    [[nodiscard]] std::optional<Register> free_register(
        bool alpha, int stage_number, const std::map<RegisterPart, int>& until,
        const std::map<RegisterPart, int>& written) const {
        std::vector<Register> candidates{Register::spare0, Register::spare1, Register::col0,
                                         Register::col1};
        for (int i = 0; i < m_machine.texture_units; ++i) candidates.push_back(tex(i));
        for (const Register reg : candidates) {
            const RegisterPart part{reg, alpha};
            const auto last = until.find(part);
            if ((last == until.end() || last->second <= stage_number) && !written.contains(part))
                return reg;
        }
        return std::nullopt;
    }

    template <class Turn>
    void copy_output(const Value& v, Register reg, const Turn& turn, GeneralStage& made) const {
        const Portion& from = portion(v);
        Portion& to = v.in_alpha ? made.alpha : made.rgb;
        to.scale = from.scale;
        to.bias_minus_half = from.bias_minus_half;
        to.wide = from.wide;
        std::size_t read = 0;
        const auto copy = [&](Input& input, const Input& original) {
            input = original;
            turn(input, v.reads[read++]);
        };
        if (v.output != 1) {
            copy(to.a, from.a);
            copy(to.b, from.b);
            to.ab_product = from.ab_product;
        }
        if (v.output != 0) {
            copy(to.c, from.c);
            copy(to.d, from.d);
            to.cd_product = from.cd_product;
        }
        (v.output == 0 ? to.ab_out : v.output == 1 ? to.cd_out : to.third_out) = reg;
    }

    /// The constants of a pass, where the machine has one pair for all stages.
    class Constants {
      public:
        explicit Constants(const CombinerProgram& program) : m_program(program) {}

        /// Which register `input` of a stage, or of the final combiner, finds its constant in.
        Register place(const Input& input, const GeneralStage* s) {
            if (input.reg != Register::const0 && input.reg != Register::const1) return input.reg;
            const bool second = input.reg == Register::const1;
            glm::vec4 value = second ? m_program.const1 : m_program.const0;
            if (s != nullptr) value = (second ? s->const1 : s->const0).value_or(value);
            const auto at = std::ranges::find(m_values, value);
            const auto i = at - m_values.begin();
            if (at == m_values.end()) m_values.push_back(value);
            return i == 0 ? Register::const0 : Register::const1;
        }
        [[nodiscard]] bool fit() const { return m_values.size() <= 2; }
        [[nodiscard]] glm::vec4 value(std::size_t i) const {
            return i < m_values.size() ? m_values[i] : glm::vec4(0.0F);
        }

      private:
        const CombinerProgram& m_program;
        std::vector<glm::vec4> m_values;
    };

    [[nodiscard]] bool constants_agree(const Slice& slice, const FinalCombiner& final_combiner,
                                       const std::vector<Wanted>& wanted) const {
        if (m_machine.stage_constants) return true;
        Constants constants(m_program);
        for (const int id : slice.values) {
            const Value& v = m_values[at(id)];
            for_each_input(portion(v), v.output,
                           [&](const Input& i) { constants.place(i, &stage(v.stage)); });
        }
        for (const Wanted& w : wanted) constants.place(final_combiner.*w.input, nullptr);
        return constants.fit();
    }

    bool set_constants(CombinerProgram& pass) {
        if (m_machine.stage_constants) return true;
        Constants constants(m_program);
        for (GeneralStage& s : pass.stages) {
            for (Portion* p : {&s.rgb, &s.alpha}) {
                for (Input* i : {&p->a, &p->b, &p->c, &p->d}) i->reg = constants.place(*i, &s);
            }
        }
        for (const auto input : kFinalInputs) {
            Input& i = pass.final_combiner.*input;
            i.reg = constants.place(i, nullptr);
        }
        if (!constants.fit()) {
            return fail("a pass reads more than two constants, and the machine has one pair");
        }
        pass.const0 = constants.value(0);
        pass.const1 = constants.value(1);
        for (GeneralStage& s : pass.stages) {
            s.const0.reset();
            s.const1.reset();
        }
        return true;
    }

    const CombinerProgram& m_program;
    const Machine& m_machine;
    std::vector<Value> m_values;
    std::vector<std::map<RegisterPart, int>> m_before;  ///< a stage, after its fetches
    std::map<RegisterPart, int> m_after;
    bool m_switches = false;
    std::vector<ProgramPass> m_passes;
    std::string m_obstacle;
};

}  // namespace

std::optional<std::vector<ProgramPass>> passes_by_value(const CombinerProgram& program,
                                                        const Machine& machine,
                                                        std::span<const UnitTexels> units,
                                                        std::string& obstacle) {
    ValueSplitter splitter(program, machine, units);
    if (splitter.split()) return splitter.take();
    obstacle = splitter.obstacle();
    return std::nullopt;
}

}  // namespace burnish
