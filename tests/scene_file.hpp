#pragma once

#include <burnish/files.hpp>
#include <string>

#include "tests/scratch_directory.hpp"

namespace burnish {

/// A test of scene files: they are written as s.toml, next to whatever else it writes.
class SceneFile : public ScratchDirectory {
  protected:
    /// The scene that `text` describes, after "schema = 1" in line 1.
    Scene scene(const std::string& text) {
        write(path("s.toml"), "schema = 1\n" + text);
        return load_scene(path("s.toml")).scene;
    }
};

}  // namespace burnish
