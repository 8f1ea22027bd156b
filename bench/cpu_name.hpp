#pragma once

#include <algorithm>
#include <fstream>
#include <string>

namespace burnish {

/// As the system calls the processor, with family and model, which a virtual machine's name leaves
/// out: "AMD EPYC (family 25, model 1)".
inline std::string cpu_name() {
    std::ifstream file("/proc/cpuinfo");
    std::string name, family, model;
    for (std::string line; std::getline(file, line) && !line.empty();) {
        const std::string value = line.substr(std::min(line.size(), line.find(':') + 2));
        if (line.starts_with("model name")) name = value;
        if (line.starts_with("cpu family")) family = value;
        if (line.starts_with("model\t")) model = value;
    }
    if (name.empty()) return "unknown";
    return family.empty() ? name : name + " (family " + family + ", model " + model + ")";
}

}  // namespace burnish
