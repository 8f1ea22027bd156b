#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <burnish/error.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

/// That a message contains `part`; shows the whole of it if not.
#define EXPECT_SAYS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

namespace burnish {

/// A test with a directory of its own that is gone afterwards.
class ScratchDirectory : public testing::Test {
  protected:
    ScratchDirectory() {
        std::string pattern = (std::filesystem::temp_directory_path() / "burnish-XXXXXX").string();
        if (mkdtemp(pattern.data()) != nullptr) m_directory = pattern;
    }
    ~ScratchDirectory() override {
        std::error_code ignored;
        if (!m_directory.empty()) std::filesystem::remove_all(m_directory, ignored);
    }

    void SetUp() override { ASSERT_FALSE(m_directory.empty()); }

    const std::filesystem::path& directory() const { return m_directory; }
    std::filesystem::path path(const std::string& name) const { return m_directory / name; }

    static std::string read(const std::filesystem::path& file) {
        std::ifstream stream(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    }
    static void write(const std::filesystem::path& file, const std::string& bytes) {
        std::ofstream(file, std::ios::binary) << bytes;
    }

    /// Names of what lies in the directory, hidden files included, sorted.
    std::vector<std::string> entries() const {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(m_directory))
            names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }

    /// The one line that `load` complains with, without the name of the directory.
    template <class Load>
    std::string complaint_of(Load&& load) const {
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

  private:
    std::filesystem::path m_directory;
};

}  // namespace burnish
