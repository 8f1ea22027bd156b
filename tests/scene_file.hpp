#pragma once

#include <burnish/error.hpp>
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

    /// The one line that `load` complains with, without the name of the directory.
    template <class Load>
    std::string complaint_of(Load&& load) {
        try {
            load();
        } catch (const Error& error) {
            std::string what = error.what();
            EXPECT_EQ(what.find('\n'), std::string::npos) << what;
            const std::string root = directory().string() + "/";
            for (std::size_t at = what.find(root); at != std::string::npos; at = what.find(root))
                what.erase(at, root.size());
            return what;
        }
        ADD_FAILURE() << "no error";
        return {};
    }
};

}  // namespace burnish
