#include "core/file_library.hpp"
#include "io/atomic_file.hpp"
#include "io/experiment_io.hpp"
#include "io/image_io.hpp"
#include "io/input_files.hpp"
#include "io/read_mesh.hpp"
#include "io/scene_io.hpp"
#include "io/view_state_io.hpp"
#include "io/write_mesh.hpp"

/// What burnish looks up when a file is first needed.
extern "C" const burnish::FileLibrary* burnish_file_library() {
    static constexpr burnish::FileLibrary kLibrary{
        .load_mesh = burnish::read_mesh_file,
        .load_image = burnish::read_image_file,
        .load_frame = burnish::read_frame_file,
        .save_frame = burnish::write_frame_file,
        .save_image = burnish::write_image_file,
        .draw_text = burnish::draw_text_into,
        .save_text = burnish::write_text_file,
        .save_mesh = burnish::write_mesh_file,
        .load_scene = burnish::read_scene_file,
        .load_material = burnish::read_material_file,
        .load_experiment = burnish::read_experiment_file,
        .input_files = burnish::find_input_files,
        .load_view_state = burnish::read_view_state_file,
        .scene_for_mesh = burnish::scene_for_mesh_file,
    };
    return &kLibrary;
}
