#include <algorithm>
#include <string_view>

#include "bench/count_instructions.hpp"
#include "bench/kernels/stages.hpp"
#include "bench/run_benchmarks.hpp"

/// --instructions: every kernel runs once, and its instructions are counted (x86-64).
int main(int argc, char** argv) {
    using namespace burnish;
    char** const end = std::remove(argv, argv + argc, std::string_view("--instructions"));
    if (can_count_instructions() && end != argv + argc) bench::count_instructions_only();
    argc = static_cast<int>(end - argv);
    bench::add_transform();
    bench::add_setup();
    bench::add_light_vertices();
    bench::add_rasterize();
    bench::add_rasterize_depths();
    bench::add_cover();
    bench::add_clear();
    bench::add_small_triangles();
    bench::add_collect();
    bench::add_attribute_planes();
    bench::add_attributes();
    bench::add_lighting_and_encode();
    bench::add_texels();
    bench::add_levels();
    bench::add_texture_shader();
    bench::add_combiners();
    bench::add_stores();
    bench::add_fragment_tests();
    return run_benchmarks(argc, argv);
}
