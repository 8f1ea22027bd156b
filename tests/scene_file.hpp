#pragma once

#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <string>
#include <vector>

#include "tests/scratch_directory.hpp"

namespace burnish {

/// A test of scene files: they are written as s.toml, next to whatever else it writes.
class SceneFile : public ScratchDirectory {
  protected:
    /// The scene that `text` describes, after "schema = 1" in line 1.
    Scene scene(const std::string& text, const std::vector<std::string>& overrides = {}) {
        write(path("s.toml"), "schema = 1\n" + text);
        return load_scene(path("s.toml"), overrides).scene;
    }
};

/// And what is wrong with the file.
class SceneFiles : public SceneFile {
  protected:
    struct Complaint {
        std::string text;
        ErrorCode code = ErrorCode::io;
    };

    /// What is wrong with it; the path of the scene file is cut off.
    Complaint complaint(const std::string& text, const std::vector<std::string>& overrides = {}) {
        try {
            scene(text, overrides);
        } catch (const Error& error) {
            std::string what = error.what();
            EXPECT_EQ(what.find('\n'), std::string::npos) << what;
            const std::string file = path("s.toml").string();
            if (what.starts_with(file)) what = "FILE" + what.substr(file.size());
            return {what, error.code()};
        }
        ADD_FAILURE() << "no error for: " << text;
        return {};
    }

    std::string bad(const std::string& text, const std::vector<std::string>& overrides = {}) {
        const Complaint found = complaint(text, overrides);
        EXPECT_EQ(found.code, ErrorCode::bad_input) << found.text;
        return found.text;
    }
};

}  // namespace burnish
