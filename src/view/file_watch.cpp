#include "view/file_watch.hpp"

#include <burnish/error.hpp>
#include <burnish/files.hpp>

namespace burnish::view {
namespace {

/// The earliest time for a file that is not there.
std::filesystem::file_time_type written(const std::filesystem::path& file) {
    std::error_code failure;
    const auto time = std::filesystem::last_write_time(file, failure);
    return failure ? std::filesystem::file_time_type::min() : time;
}

}  // namespace

void FileWatch::watch(const std::vector<std::filesystem::path>& files) {
    m_files.clear();
    for (const std::filesystem::path& file : files) {
        const Time time = written(file);
        m_files.push_back({file, time, time});
    }
}

void FileWatch::watch_input(const std::filesystem::path& input) {
    try {
        watch(input_files(input));
    } catch (const Error&) {
        watch({input});
    }
}

bool FileWatch::changed() {
    bool any = false;
    for (Watched& each : m_files) {
        const Time now = written(each.file);
        if (now == each.seen && now != each.reported) {
            each.reported = now;
            any = true;
        }
        each.seen = now;
    }
    return any;
}

}  // namespace burnish::view
