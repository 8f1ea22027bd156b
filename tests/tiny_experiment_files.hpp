#pragma once

#include <filesystem>
#include <string>

#include "tests/run_command.hpp"

namespace burnish {

/// tiny.toml, an experiment of 2 x 2 cells of 40 x 30 pixels, a sphere each.
class TinyExperiment : public Command {
  protected:
    void write_tiny_experiment() {
        std::filesystem::create_directory(path("scenes"));
        write_scene("scenes/ball.toml", "material = \"metal\"\n[[materials]]\nname = \"metal\"\n");
        write_experiment("");
    }

    void write_experiment(const std::string& more, const std::string& file = "scenes/ball.toml") {
        write(path("tiny.toml"), R"(schema = 1
title = "Tiny & small"
hypothesis = "A machine is not exact."
metrics = ["rmse", "bias", "flicker"]
[[scenes]]
name = "ball"
file = ")" + file + R"("
[[sweeps]]
name = "machine"
key = "machine.profile"
values = ["nv2a", "ideal"]
quick = ["ideal"]
[[sweeps]]
name = "width"
variants = [
  { label = 0.3, set = { "materials.metal.alpha_x" = 0.3 } },
  { label = 0.6, set = { "materials.metal.alpha_x" = 0.6 } },
]
[pan]
frames = 3
samples = 4
[reference]
samples = 1
set = { "machine.profile" = "double" }
[[plots]]
title = "errors"
x = "width"
y = "rmse"
[[sheets]]
title = "pictures"
where = { machine = "nv2a", width = 0.3 }
[[expect]]
text = "nine bits are worse"
metric = "rmse"
measure = "ratio"
where = { machine = "nv2a" }
versus = { machine = "ideal" }
at_least = 1
)" + more);
    }
};

}  // namespace burnish
