// The one file that sees CLI11, which takes seconds to compile.
#include "app/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <burnish/error.hpp>
#include <burnish/framebuffer.hpp>
#include <burnish/materials.hpp>
#include <burnish/shapes.hpp>
#include <charconv>
#include <cmath>

#include "core/nearest.hpp"

namespace burnish::app {
namespace {

[[noreturn]] void fail(const std::string& message) {
    throw Error(ErrorCode::bad_option, message);
}

/// `count` finite numbers with commas between them; `option` is for the message.
template <class Number = float>
std::vector<Number> parse_numbers(const std::string& option, const std::string& text,
                                  std::size_t least, std::size_t most) {
    std::vector<Number> values;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (true) {
        Number value = 0;
        const auto [stop, failure] = std::from_chars(at, end, value);
        const bool separated = stop == end || *stop == ',';
        if (failure != std::errc() || !separated || !std::isfinite(value)) break;
        values.push_back(value);
        if (stop == end) {
            if (values.size() < least || values.size() > most) break;
            return values;
        }
        at = stop + 1;
    }
    fail(fmt::format(
        "{} {}, expected {} numbers with commas between them", option, text,
        least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most)));
}

glm::vec3 parse_vec3(const std::string& option, const std::string& text) {
    const std::vector<float> v = parse_numbers(option, text, 3, 3);
    return {v[0], v[1], v[2]};
}

glm::ivec2 parse_size(const std::string& text) {
    glm::ivec2 size{0, 0};
    const char* const end = text.data() + text.size();
    const auto [cross, bad_width] = std::from_chars(text.data(), end, size.x);
    if (bad_width == std::errc() && cross != end && *cross == 'x') {
        const auto [stop, bad_height] = std::from_chars(cross + 1, end, size.y);
        const bool fits = size.x >= 1 && size.y >= 1 && size.x <= Framebuffer::kMaxSize &&
                          size.y <= Framebuffer::kMaxSize;
        if (bad_height == std::errc() && stop == end && fits) return size;
    }
    fail(
        fmt::format("--size {}, expected WIDTHxHEIGHT, each 1 .. {}", text, Framebuffer::kMaxSize));
}

glm::ivec2 parse_pixel(const std::string& text) {
    glm::ivec2 pixel{0, 0};
    const char* const end = text.data() + text.size();
    const auto [comma, bad_x] = std::from_chars(text.data(), end, pixel.x);
    if (bad_x == std::errc() && comma != end && *comma == ',') {
        const auto [stop, bad_y] = std::from_chars(comma + 1, end, pixel.y);
        if (bad_y == std::errc() && stop == end && pixel.x >= 0 && pixel.y >= 0) return pixel;
    }
    fail(fmt::format("--pixel {}, expected X,Y: column and row, from 0,0 in the upper left corner",
                     text));
}

Light parse_light(const std::string& text) {
    const std::vector<float> v = parse_numbers("--light", text, 3, 4);
    Light light;
    light.position = {v[0], v[1], v[2]};
    light.position_w = v.size() == 4 ? v[3] : 0.0F;
    if (light.position_w != 0.0F && light.position_w != 1.0F)
        fail(fmt::format("--light {}, expected W = 0 for a direction or 1 for a position", text));
    if (light.position_w == 0.0F && light.position == glm::vec3(0.0F))
        fail(fmt::format("--light {}, expected a direction that is not zero", text));
    return light;
}

glm::vec4 parse_background(const std::string& text) {
    const std::vector<float> v = parse_numbers("--background", text, 3, 4);
    for (const float value : v) {
        if (value < 0.0F || value > 1.0F)
            fail(fmt::format("--background {}, expected numbers of 0 .. 1", text));
    }
    return {v[0], v[1], v[2], v.size() == 4 ? v[3] : 1.0F};
}

/// Options of which one of a few words is the value.
std::string known_word(const std::string& option, const std::string& word,
                       const std::vector<std::string_view>& known) {
    for (const std::string_view name : known) {
        if (name == word) return word;
    }
    fail(fmt::format("{} {}, {}", option, word, expected_one_of(word, known)));
}

Model known_model(const std::string& name) {
    const std::optional<Model> model = model_named(name);
    return model ? *model : *model_named(known_word("--model", name, model_names()));
}

/// METHOD or METHOD:BITS.
MaterialMipmaps parse_mipmaps(const std::string& text) {
    const std::size_t colon = text.find(':');
    const std::string name = text.substr(0, colon);
    MaterialMipmaps mipmaps;
    mipmaps.method = *mip_method_named(known_word("--mipmaps", name, mip_method_names()));
    if (colon == std::string::npos) return mipmaps;
    const std::string bits = text.substr(colon + 1);
    if (bits != "8" && bits != "16" && bits != "32")
        fail(fmt::format("--mipmaps {}, expected 8, 16 or 32 bits after the colon", text));
    mipmaps.bits = std::stoi(bits);
    return mipmaps;
}

Register parse_register(const std::string& name) {
    std::vector<std::string_view> known;
    for (int r = 0; r < static_cast<int>(Register::discard); ++r) {
        const auto reg = static_cast<Register>(r);
        if (register_name(reg) == name) return reg;
        known.push_back(register_name(reg));
    }
    fail(fmt::format("--aov: unknown register '{}', {}", name, expected_one_of(name, known)));
}

/// register:NAME, register:NAME@STAGE, register:NAME@inputs or register:NAME@final.
ShownRegister parse_shown_register(const std::string& text) {
    constexpr std::string_view kKind = "register:";
    const std::string_view rest = std::string_view(text).substr(kKind.size());
    const std::size_t at = rest.find('@');
    ShownRegister shown{.reg = parse_register(std::string(rest.substr(0, at)))};
    if (at == std::string_view::npos) return shown;
    const std::string_view place = rest.substr(at + 1);
    if (place == "final") return shown;
    if (place == "inputs") {
        shown.stages = 0;
        return shown;
    }
    std::size_t stage = 0;
    const char* const end = place.data() + place.size();
    const auto [stop, failure] = std::from_chars(place.data(), end, stage);
    if (failure != std::errc() || stop != end || stage >= ShownRegister::kAllStages) {
        fail(fmt::format("--aov {}, expected a stage of 0 .. {}, inputs or final after @", text,
                         ShownRegister::kAllStages - 1));
    }
    shown.stages = stage + 1;
    return shown;
}

Shown parse_aov(const std::string& text) {
    constexpr std::array<std::pair<std::string_view, Aov>, 7> kAovs{{{"depth", Aov::depth},
                                                                     {"normal", Aov::normal},
                                                                     {"tangent", Aov::tangent},
                                                                     {"bitangent", Aov::bitangent},
                                                                     {"stripes", Aov::stripes},
                                                                     {"uv", Aov::uv},
                                                                     {"triangle", Aov::triangle}}};
    if (text.starts_with("register:")) return parse_shown_register(text);
    for (const auto& [name, aov] : kAovs)
        if (text == name) return aov;
    fail(
        fmt::format("--aov {}, expected depth, normal, tangent, bitangent, stripes, uv, triangle, "
                    "register:NAME or register:NAME@STAGE",
                    text));
}

int root_of(int samples) {
    for (int side = 1; side <= 32; ++side)
        if (side * side == samples) return side;
    fail(fmt::format("--samples {}, expected a square, 1 .. 1024", samples));
}

void add_aov(CLI::App& verb, std::optional<Shown>& shown) {
    verb.add_option_function<std::string>(
            "--aov", [&shown](const std::string& text) { shown = parse_aov(text); },
            "Shown instead of colours: depth, normal, tangent, uv, triangle, or a register, e.g. "
            "register:spare0@1 after stage 1, ...@inputs, @final")
        ->type_name("WHAT");
}

void add_camera_options(CLI::App& verb, CameraOptions& camera) {
    const auto add_vec3 = [&](const char* name, std::optional<glm::vec3>& target,
                              const char* text) {
        verb.add_option_function<std::string>(
                name,
                [name, &target](const std::string& value) { target = parse_vec3(name, value); },
                text)
            ->type_name("X,Y,Z");
    };
    add_vec3("--camera-position", camera.position, "Where the camera stands");
    add_vec3("--camera-focal-point", camera.focal_point, "What it looks at");
    add_vec3("--camera-view-up", camera.view_up, "What is up in the picture");
    verb.add_option("--camera-view-angle", camera.view_angle, "Vertical angle of view in degrees")
        ->check(CLI::Range(0.001, 179.9))
        ->type_name("DEG");
    verb.add_option("--camera-azimuth", camera.azimuth, "Turns the camera about the focal point")
        ->check(CLI::Range(-1e6, 1e6))
        ->type_name("DEG");
    verb.add_option("--camera-elevation", camera.elevation, "Raises it, looking at the focal point")
        ->check(CLI::Range(-1e6, 1e6))
        ->type_name("DEG");
    verb.add_option("--camera-zoom", camera.zoom, "Divides the angle of view")
        ->check(CLI::Range(0.001, 1e6))
        ->type_name("FACTOR");
}

void add_picture_options(CLI::App& verb, PictureOptions& picture) {
    verb.add_option("INPUT", picture.input, "Scene (.toml) or mesh (.obj .ply .off .stl)")
        ->required()
        ->type_name("");
    verb.add_option_function<std::string>(
            "--size", [&picture](const std::string& text) { picture.size = parse_size(text); },
            "Size of the picture in pixels")
        ->type_name("WxH");
    verb.add_option("--threads", picture.threads, "Workers, exactly that many; 0: one per core")
        ->check(CLI::Range(0, 1024))
        ->type_name("N");
    verb.add_option("--isa", picture.isa, "Instruction set; `burnish info` lists them")
        ->type_name("NAME");
    verb.add_option_function<std::string>(
            "--machine",
            [&picture](const std::string& name) {
                picture.machine = known_word("--machine", name, machine_profile_names());
            },
            "Machine profile: geforce256, nv2a or ideal; or double, formulas instead of a machine")
        ->type_name("PROFILE");
    verb.add_option("--material", picture.material,
                    "Material file (.toml) for every mesh, instead of its own")
        ->type_name("FILE");
    verb.add_option_function<std::string>(
            "--model", [&picture](const std::string& name) { picture.model = known_model(name); },
            "Reflectance model of every mesh, instead of its material's; `burnish info` lists them")
        ->type_name("NAME");
    verb.add_option_function<std::string>(
            "--mipmaps",
            [&picture](const std::string& text) { picture.mipmaps = parse_mipmaps(text); },
            "How mip levels of every reflectance model's parameters are made: none, maps, box, "
            "normalize, mag, toksvig, clean, lean, moments, moments_unweighted; their moments "
            "stored in 8, 16 or 32 bits")
        ->type_name("METHOD[:BITS]");
    verb.add_option("--max-anisotropy", picture.max_anisotropy,
                    "Most probes along the longer axis of what a pixel covers, 1 .. 16, of every "
                    "reflectance model with mipmaps")
        ->check(CLI::Range(1, Sampler::kMostProbes))
        ->type_name("N");
    verb.add_flag("--multipass", picture.multipass,
                  "Split programs that need more than the machine has into passes");
    verb.add_option_function<std::string>(
            "--half-vector",
            [&picture](const std::string& word) {
                Machine tried;
                choose_half_vector(tried, word);
                picture.half_vector = word;
            },
            "Where half vectors are computed: pixel, vertex, or cube:N, per vertex and normalised "
            "by "
            "a cube map of N texels a side")
        ->type_name("WHERE");
    verb.add_option_function<std::string>(
            "--filter-order",
            [&picture](const std::string& word) { picture.filter_order = filter_order_of(word); },
            "Textures are filtered before the combiners, or their results afterwards: before or "
            "after")
        ->type_name("ORDER");
    add_camera_options(verb, picture.camera);
    verb.add_option_function<std::vector<std::string>>(
            "--light",
            [&picture](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) picture.lights.push_back(parse_light(text));
            },
            "A light, instead of the scene's: direction towards it, or its position if W is 1; may "
            "be given several times")
        ->allow_extra_args(false)
        ->type_name("X,Y,Z[,W]");
    verb.add_option_function<std::string>(
            "--background",
            [&picture](const std::string& text) { picture.background = parse_background(text); },
            "Colour where nothing is drawn, 0 .. 1")
        ->type_name("R,G,B[,A]");
    verb.add_option("-D", picture.overrides, "Any key of the scene, e.g. -D camera.near=0.5")
        ->allow_extra_args(false)
        ->type_name("KEY.PATH=VALUE");
    CLI::Option* quiet = verb.add_flag("--quiet", picture.quiet, "Print errors only");
    verb.add_flag("-v,--verbose", picture.verbose, "Print what was loaded and drawn")
        ->excludes(quiet);
}

void add_render(CLI::App& verb, RenderOptions& options) {
    add_picture_options(verb, options.picture);
    verb.add_option("-o,--output", options.output,
                    "Image file, PNG, EXR or other by extension; - writes PNG to standard output")
        ->type_name("FILE");
    verb.add_option_function<int>(
            "--samples", [&options](int samples) { options.samples_side = root_of(samples); },
            "Samples per pixel: 1, 4, 9 or 16; with profile double any square up to 1024")
        ->type_name("N");
    verb.add_option("--turntable", options.turntable,
                    "Pictures of one turn about the focal point; the output name holds {frame:4}")
        ->check(CLI::Range(1, 9999))
        ->type_name("N");
    verb.add_option_function<std::string>(
            "--stats",
            [&options](const std::string& word) {
                options.stats = known_word("--stats", word, {"text", "json"}) == "json"
                                    ? StatsFormat::json
                                    : StatsFormat::text;
            },
            "Print counts and times of the frame: text or json")
        ->type_name("FORMAT");
    add_aov(verb, options.shown);
}

void add_trace(CLI::App& verb, TraceOptions& options) {
    add_picture_options(verb, options.picture);
    verb.add_option_function<std::string>(
            "--pixel", [&options](const std::string& text) { options.pixel = parse_pixel(text); },
            "Column and row of the pixel; 0,0 is the upper left corner")
        ->type_name("X,Y");
    CLI::Option* by_stage = verb.add_flag("--by-stage", options.by_stage,
                                          "Instead of registers: how much of the picture's error, "
                                          "or of the pixel's, each stage makes");
    verb.add_option("--bits", options.bits,
                    "With --by-stage: bits of all stages, N, or of some, half_vector=8,combiners=9,"
                    "stage0=exact,..; default: the machine's")
        ->needs(by_stage)
        ->type_name("BITS");
    verb.add_option("--rounding", options.rounding,
                    "With --by-stage: nearest, truncate, shift8 or stochastic")
        ->needs(by_stage)
        ->type_name("HOW");
    verb.add_option("-o,--output", options.output,
                    "With --by-stage: a waterfall as SVG, by gnuplot")
        ->needs(by_stage)
        ->type_name("FILE.svg");
    verb.add_flag("--json", options.json, "Print JSON");
}

void add_bench(CLI::App& verb, BenchOptions& options) {
    add_picture_options(verb, options.picture);
    verb.add_option("--frames", options.frames, "Frames to time, after two that are not")
        ->check(CLI::Range(1, 1000000))
        ->type_name("N");
    verb.add_flag("--balance", options.balance,
                  "Instead of the times: how evenly tiles would keep 1 .. 64 workers busy");
    verb.add_flag("--json", options.json, "Print JSON");
    add_aov(verb, options.shown);
}

metrics::Metric known_metric(const std::string& option, const std::string& name) {
    const std::optional<metrics::Metric> metric = metrics::metric_named(name);
    return metric ? *metric
                  : *metrics::metric_named(known_word(option, name, metrics::metric_names()));
}

Threshold parse_threshold(const std::string& text) {
    const std::size_t sign = text.find('=');
    if (sign == std::string::npos)
        fail(fmt::format("--threshold {}, expected NAME=VALUE, such as rmse=0.01", text));
    const std::string name = text.substr(0, sign);
    const metrics::Metric metric = known_metric("--threshold", name);
    const std::string number = text.substr(sign + 1);
    return {metric, parse_numbers<double>("--threshold " + name, number, 1, 1).front()};
}

metrics::Exposures parse_exposures(const std::string& text) {
    const std::vector<double> v = parse_numbers<double>("--exposures", text, 2, 3);
    const double count = v.size() == 3 ? v[2] : std::max(2.0, std::ceil(v[1] - v[0]));
    if (v[1] < v[0] || count != std::floor(count) || count < 1.0 || count > metrics::kMostExposures)
        fail(fmt::format(
            "--exposures {}, expected START,STOP[,COUNT] with START <= STOP and 1 .. {} "
            "exposures",
            text, metrics::kMostExposures));
    return {v[0], v[1], static_cast<int>(count)};
}

void add_compare_measures(CLI::App& verb, metrics::CompareOptions& measured,
                          std::vector<Threshold>& thresholds) {
    verb.add_option_function<std::vector<std::string>>(
            "--metric",
            [&measured](const std::vector<std::string>& names) {
                measured.metrics.clear();
                for (const std::string& name : names)
                    measured.metrics.push_back(known_metric("--metric", name));
            },
            fmt::format("Only these, with commas between them: {}",
                        fmt::join(metrics::metric_names(), ", ")))
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("NAME");
    verb.add_option_function<std::vector<std::string>>(
            "--threshold",
            [&thresholds](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) thresholds.push_back(parse_threshold(text));
            },
            "Exit code 1 if a metric is worse; of bias and energy_ratio, the distance from 0 and 1")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("NAME=VALUE");
    verb.add_option_function<std::string>(
            "--mask",
            [&measured](const std::string& word) {
                known_word("--mask", word, {"all", "covered", "interior"});
                measured.region = word == "all"       ? metrics::Region::all
                                  : word == "covered" ? metrics::Region::covered
                                                      : metrics::Region::interior;
            },
            "Pixels that count, by the reference's alpha: all, covered, or interior, whose eight "
            "neighbours are covered, too")
        ->type_name("WHICH");
    verb.add_option("--pixels-per-degree", measured.flip.pixels_per_degree,
                    "Of the viewer, for FLIP; default 67.02")
        ->check(CLI::Range(metrics::kLeastPixelsPerDegree, metrics::kMostPixelsPerDegree))
        ->type_name("PPD");
    verb.add_option_function<std::string>(
            "--encoding",
            [&measured](const std::string& word) {
                known_word("--encoding", word, {"srgb", "linear"});
                measured.flip.encoding =
                    word == "srgb" ? metrics::Encoding::srgb : metrics::Encoding::linear;
            },
            "What FLIP takes numbers for: srgb, as a screen shows them, the default; or linear")
        ->type_name("CODE");
    verb.add_option_function<std::string>(
            "--exposures",
            [&measured](const std::string& text) {
                measured.flip.exposures = parse_exposures(text);
            },
            "Of flip_hdr in stops, instead of those that suit the reference")
        ->type_name("START,STOP[,COUNT]");
}

void add_compare(CLI::App& verb, CompareOptions& options) {
    verb.add_option("TEST", options.test, "Image file")->required()->type_name("");
    verb.add_option("REFERENCE", options.reference, "Image file of the same size")
        ->required()
        ->type_name("");
    add_compare_measures(verb, options.measured, options.thresholds);
    verb.add_option("--difference", options.difference,
                    "Image of test - reference: .exr the numbers, others grey where there is none")
        ->type_name("FILE");
    verb.add_option("--absolute-difference", options.absolute_difference,
                    "Image of its size, black where there is none")
        ->type_name("FILE");
    verb.add_option("--gain", options.gain, "Multiplies both, but for .exr; default 1")
        ->check(CLI::Range(1e-6, 1e6))
        ->type_name("G");
    verb.add_option("--heat-map", options.heat_map,
                    "Image of FLIP: colours from black to light yellow, .exr the numbers; of "
                    "flip_hdr where --metric names that and not flip")
        ->type_name("FILE");
    verb.add_option("--threads", options.threads, "Workers, exactly that many; 0: one per core")
        ->check(CLI::Range(0, 1024))
        ->type_name("N");
    CLI::Option* json = verb.add_flag("--json", options.json, "Print JSON");
    verb.add_flag("--quiet", options.quiet, "Print errors only")->excludes(json);
}

/// The machines that run programs.
std::vector<std::string_view> program_profiles() {
    std::vector<std::string_view> names = machine_profile_names();
    std::erase_if(names,
                  [](std::string_view name) { return machine_profile(name).double_precision; });
    return names;
}

/// A program's files, or a model.
void add_compile(CLI::App& verb, CompileOptions& program, CompileModelOptions& model) {
    CLI::Option* file =
        verb.add_option("FILE.rc", program.combiners, "Combiners: !!RC1.0 or !!BRN1.0")
            ->type_name("");
    verb.add_option("FILE.ts", program.texture_shader, "Texture shader: !!TS1.0")->type_name("");
    verb.add_option_function<std::string>(
            "--model", [&model](const std::string& name) { model.model = known_model(name); },
            "A reflectance model instead of a program, of the default material or of that of "
            "--material; `burnish info` lists them")
        ->excludes(file)
        ->type_name("NAME");
    verb.add_option("--material", model.material,
                    "Material file (.toml): its parameters, and without --model its model")
        ->excludes(file)
        ->type_name("FILE");
    verb.add_option_function<std::string>(
            "--machine",
            [&model](const std::string& name) {
                model.machine = known_word("--machine", name, program_profiles());
            },
            "What to compile the model for: geforce256, nv2a or ideal, the default")
        ->excludes(file)
        ->type_name("PROFILE");
    verb.add_flag_function(
        "--json", [&](std::int64_t) { program.json = model.json = true; }, "Print JSON");
}

void add_bake_mesh(CLI::App& verb, BakeMeshOptions& options) {
    verb.add_option_function<std::string>(
            "SHAPE",
            [&options](const std::string& word) {
                options.shape = known_word("shape", word, shapes::names());
            },
            "sphere, knot, plane or cube")
        ->required()
        ->type_name("");
    verb.add_option("--columns", options.columns, "Columns of the grid; segments along the knot")
        ->type_name("N");
    verb.add_option("--rows", options.rows, "Rows of the grid; sides of the knot's tube")
        ->type_name("N");
    verb.add_option("-o,--output", options.output, "Mesh file, .ply or .obj")
        ->required()
        ->type_name("FILE");
}

void add_bake_brushed(CLI::App& verb, BakeBrushedOptions& options) {
    verb.add_option("--seed", options.seed, "Another seed gives other scratches")->type_name("N");
    verb.add_option("--size", options.size, "Side of the square maps in texels")
        ->check(CLI::Range(1, 4096))
        ->type_name("N");
    verb.add_option("-o,--output", options.output,
                    "Directory, or what the names of the four PNG files begin with")
        ->required()
        ->type_name("DIR-OR-PREFIX");
}

void add_bake_material(CLI::App& verb, BakeMaterialOptions& options) {
    verb.add_option_function<std::string>(
            "NAME",
            [&options](const std::string& word) {
                options.set = known_word("material", word, generated_set_names());
            },
            "brushed, lathe, cross_hatch, sunburst, orbital, corrosion, fingerprint or weave")
        ->required()
        ->type_name("");
    verb.add_option("--seed", options.seed, "Another seed gives other marks")->type_name("N");
    verb.add_option("--size", options.size, "Side of the square maps in texels")
        ->check(CLI::Range(1, kMaxGeneratedSize))
        ->type_name("N");
    verb.add_option("-o,--output", options.output, "Directory, made if it is not there")
        ->required()
        ->type_name("DIR");
}

void add_bake_mips(CLI::App& verb, BakeMipsOptions& options) {
    CLI::Option* file =
        verb.add_option("MATERIAL.toml", options.material, "Material file")->type_name("");
    CLI::Option* set =
        verb.add_option_function<std::string>(
                "--set",
                [&options](const std::string& word) {
                    options.set = known_word("--set", word, generated_set_names());
                },
                "A generated set instead: brushed, lathe, cross_hatch, sunburst, orbital, "
                "corrosion, fingerprint or weave")
            ->excludes(file)
            ->type_name("NAME");
    verb.add_option("--seed", options.seed, "Another seed gives other marks")
        ->needs(set)
        ->type_name("N");
    verb.add_option("--size", options.size, "Side of the square maps in texels")
        ->check(CLI::Range(1, kMaxGeneratedSize))
        ->needs(set)
        ->type_name("N");
    verb.add_option_function<std::string>(
            "--method",
            [&options](const std::string& word) {
                std::vector<std::string_view> known = mip_method_names();
                std::erase(known, "none");
                std::erase(known, "maps");
                options.mipmaps.method = *mip_method_named(known_word("--method", word, known));
            },
            "box, normalize, mag, toksvig, clean, lean, moments or moments_unweighted; moments")
        ->type_name("METHOD");
    verb.add_option("--bits", options.mipmaps.bits,
                    "Bits that moments are stored in, else double precision")
        ->check(CLI::IsMember({8, 16, 32}))
        ->type_name("N");
    verb.add_option("-o,--output", options.output, "Directory, made if it is not there")
        ->required()
        ->type_name("DIR");
}

void add_bake_anisotropy(CLI::App& verb, BakeAnisotropyOptions& options) {
    verb.add_option("--roughness", options.roughness, "glTF's roughnessFactor, default 1")
        ->check(CLI::Range(0.0, 1.0))
        ->type_name("R");
    verb.add_option("--strength", options.strength,
                    "glTF's anisotropyStrength, default 0; with --texture 1")
        ->check(CLI::Range(0.0, 1.0))
        ->type_name("S");
    verb.add_option("--rotation", options.rotation,
                    "glTF's anisotropyRotation: radians, against the clock, default 0")
        ->check(CLI::Range(-1e3, 1e3))
        ->type_name("RAD");
    verb.add_option("--texture", options.texture, "glTF's anisotropyTexture")->type_name("FILE");
    verb.add_option("--roughness-texture", options.roughness_texture,
                    "glTF's metallicRoughnessTexture, of the same size")
        ->type_name("FILE");
    verb.add_option("--alpha-x", options.alpha_x, "Our width along the tangent, to glTF")
        ->check(CLI::Range(0.0, 1.0))
        ->type_name("A");
    verb.add_option("--alpha-y", options.alpha_y, "Our width along the bitangent")
        ->check(CLI::Range(0.0, 1.0))
        ->type_name("A");
    verb.add_option("--direction", options.direction,
                    "Our tangent's angle from u: degrees, against the clock, default 0")
        ->check(CLI::Range(-1e4, 1e4))
        ->type_name("DEG");
    verb.add_option("--material", options.material, "Material file, to textures of glTF")
        ->type_name("FILE");
    verb.add_option("-o,--output", options.output,
                    "Directory for what textures or a material turn into")
        ->type_name("DIR");
    verb.add_flag("--json", options.json, "Print numbers as JSON");
}

/// "I/N": the I-th of N parts.
void parse_shard(const std::string& text, ExperimentOptions& options) {
    constexpr int kMostShards = 100000;
    const char* const end = text.data() + text.size();
    const auto [slash, bad_shard] = std::from_chars(text.data(), end, options.shard);
    if (bad_shard == std::errc() && slash != end && *slash == '/') {
        const auto [stop, bad_shards] = std::from_chars(slash + 1, end, options.shards);
        if (bad_shards == std::errc() && stop == end && options.shard >= 1 &&
            options.shard <= options.shards && options.shards <= kMostShards)
            return;
    }
    fail(fmt::format("--shard {}, expected I/N: part I of N, 1/1 to {}/{}", text, kMostShards,
                     kMostShards));
}

/// NAME|FILE or merge DIR...: the words are sorted out by `what_to_run`.
void add_experiment(CLI::App& verb, ExperimentOptions& options, std::vector<std::string>& words) {
    verb.add_option(
            "NAME", words,
            "e1 .. e12, e7_edge, or an experiment's file; merge DIR...: join the shards in these "
            "directories")
        ->required()
        ->type_name("");
    verb.add_option("-o,--output", options.output,
                    "Directory, made if it is not there; what is finished in it is kept")
        ->required()
        ->type_name("DIR");
    verb.add_flag("--quick", options.quick, "Fewer values and samples");
    verb.add_option_function<std::string>(
            "--shard", [&options](const std::string& text) { parse_shard(text, options); },
            "Compute the I-th of N parts of the cells")
        ->type_name("I/N");
    verb.add_option("--threads", options.threads, "Worker threads, 0: one per core")
        ->check(CLI::Range(0, 1024))
        ->type_name("N");
    verb.add_flag("--quiet", options.quiet, "Print errors only");
}

/// The parser and what it fills. Nothing moves: the parser keeps references.
struct Parser {
    CLI::App app{"burnish renders meshes through an emulated register-combiner machine", "burnish"};
    RenderOptions render;
    TraceOptions trace;
    BenchOptions bench;
    CompareOptions compare;
    CompileOptions compile;
    CompileModelOptions compile_model;
    InfoOptions info;
    BakeBrushedOptions brushed;
    BakeMaterialOptions material;
    BakeMipsOptions mips;
    BakeAnisotropyOptions anisotropy;
    BakeMeshOptions mesh;
    ExperimentOptions experiment;
    std::vector<std::string> experiment_words;
    CLI::App* render_verb = app.add_subcommand("render", "A scene or mesh file to an image");
    CLI::App* trace_verb = app.add_subcommand(
        "trace", "Every register after every stage at one pixel, or the picture's error by stage");
    CLI::App* bake_verb = app.add_subcommand("bake", "Material maps and test meshes as files");
    CLI::App* brushed_verb = bake_verb->add_subcommand("brushed", "Maps of brushed steel as PNG");
    CLI::App* material_verb = bake_verb->add_subcommand(
        "material", "A generated material: maps, material file, true parameters");
    CLI::App* mips_verb =
        bake_verb->add_subcommand("mips", "A material's maps with mip levels of its parameters");
    CLI::App* anisotropy_verb =
        bake_verb->add_subcommand("anisotropy", "KHR_materials_anisotropy to our widths, and back");
    CLI::App* mesh_verb = bake_verb->add_subcommand("mesh", "A test mesh");
    CLI::App* bench_verb = app.add_subcommand("bench", "Times whole frames of a scene");
    CLI::App* compare_verb =
        app.add_subcommand("compare", "Measures how an image differs from its reference");
    CLI::App* compile_verb = app.add_subcommand(
        "compile", "Checks and prints program texts, or the program of a reflectance model");
    CLI::App* experiment_verb =
        app.add_subcommand("experiment", "Runs an experiment: cells, tables, plots and a report");
    CLI::App* info_verb =
        app.add_subcommand("info", "Version, instruction sets, profiles, formats");

    Parser() {
        app.require_subcommand(1);
        app.set_version_flag("--version", "burnish " BURNISH_VERSION);
        bake_verb->require_subcommand(1);
        add_render(*render_verb, render);
        add_trace(*trace_verb, trace);
        add_bench(*bench_verb, bench);
        add_compare(*compare_verb, compare);
        add_compile(*compile_verb, compile, compile_model);
        info_verb->add_flag("--json", info.json, "Print JSON");
        add_bake_brushed(*brushed_verb, brushed);
        add_bake_material(*material_verb, material);
        add_bake_mips(*mips_verb, mips);
        add_bake_anisotropy(*anisotropy_verb, anisotropy);
        add_bake_mesh(*mesh_verb, mesh);
        add_experiment(*experiment_verb, experiment, experiment_words);
    }

    Command what_to_run() const {
        ExperimentOptions options = experiment;
        if (experiment_words.front() == "merge") {
            options.merged.assign(experiment_words.begin() + 1, experiment_words.end());
            if (options.merged.empty()) fail("experiment merge: expected DIR...");
            if (options.shards > 1 || options.quick)
                fail(
                    "experiment merge: the directories say which form it is, expected neither "
                    "--shard nor --quick");
            return options;
        }
        options.experiment = experiment_words.front();
        if (experiment_words.size() > 1)
            fail(fmt::format("experiment {}: unexpected '{}'", options.experiment,
                             experiment_words[1]));
        return options;
    }

    Command what_to_compile() const {
        if (!compile.combiners.empty()) return compile;
        if (compile_model.model || !compile_model.material.empty()) return compile_model;
        fail("compile: expected FILE.rc, --model NAME or --material FILE");
    }

    Command what_to_filter() const {
        if (!mips.material.empty() || !mips.set.empty()) return mips;
        fail("bake mips: expected MATERIAL.toml or --set NAME");
    }

    Command chosen() const {
        if (render_verb->parsed()) return render;
        if (trace_verb->parsed()) {
            if (!trace.pixel && !trace.by_stage) fail("trace: expected --pixel X,Y or --by-stage");
            return trace;
        }
        if (bench_verb->parsed()) return bench;
        if (compare_verb->parsed()) return compare;
        if (compile_verb->parsed()) return what_to_compile();
        if (info_verb->parsed()) return info;
        if (experiment_verb->parsed()) return what_to_run();
        if (brushed_verb->parsed()) return brushed;
        if (material_verb->parsed()) return material;
        if (mips_verb->parsed()) return what_to_filter();
        if (anisotropy_verb->parsed()) return anisotropy;
        return mesh;
    }
};

std::vector<std::string_view> verb_names(const CLI::App& app) {
    std::vector<std::string_view> names;
    for (const CLI::App* verb : app.get_subcommands({})) names.emplace_back(verb->get_name());
    return names;
}

/// CLI11 speaks of unexpected arguments; for a misspelt command, say what commands there are.
const CLI::App& require_known_verbs(const CLI::App& root, int argc, const char* const* argv) {
    const CLI::App* app = &root;
    for (int i = 1; i < argc && argv[i][0] != '-'; ++i) {
        const std::vector<std::string_view> names = verb_names(*app);
        if (names.empty()) break;
        if (std::find(names.begin(), names.end(), argv[i]) == names.end())
            fail(fmt::format("unknown command '{}', {}", argv[i], expected_one_of(argv[i], names)));
        app = app->get_subcommand(argv[i]);
    }
    return *app;
}

/// The first option that `verb` does not have, with the one that was probably meant.
void require_known_options(const CLI::App& verb, int argc, const char* const* argv) {
    std::vector<std::string> owned;
    for (const CLI::Option* option : verb.get_options()) {
        for (const std::string& name : option->get_lnames()) owned.push_back("--" + name);
    }
    const std::vector<std::string_view> names(owned.begin(), owned.end());
    for (int i = 1; i < argc; ++i) {
        const std::string_view whole = argv[i];
        const std::string_view word = whole.substr(0, whole.find('='));
        if (word == "--" || !word.starts_with("--")) continue;
        if (std::find(names.begin(), names.end(), word) != names.end()) continue;
        const std::string_view near = nearest_name(word, names);
        fail(near.empty() ? fmt::format("unknown option '{}', `burnish {} --help` lists them", word,
                                        verb.get_name())
                          : fmt::format("unknown option '{}', did you mean '{}'?", word, near));
    }
}

}  // namespace

Command parse_command_line(int argc, const char* const* argv) {
    Parser parser;
    const CLI::App& verb = require_known_verbs(parser.app, argc, argv);
    try {
        parser.app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        return PrintText{verb.help()};
    } catch (const CLI::CallForVersion& version) {
        return PrintText{std::string(version.what()) + "\n"};
    } catch (const CLI::ParseError& error) {
        require_known_options(verb, argc, argv);
        fail(error.what());
    }
    return parser.chosen();
}

}  // namespace burnish::app
