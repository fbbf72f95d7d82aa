#pragma once

#include "quorient/system/system.hpp"

#include <unistd.h>
#include <filesystem>
#include <fstream>
#include <string>

namespace quorient::system {

// Small files that are in order, one of each kind.
inline const std::string simulation_file =
    "domain: 7\n"
    "unit: {id: 1, kind: gyro, layout: cone-6}\n"
    "source: {kind: simulation, noise_rad: 1.0e-6}\n"
    "lanes:\n"
    "  - {name: a, detector: {method: glt}}\n"
    "  - {name: b, detector: {method: subset}}\n"
    "voters:\n"
    "  - {name: voter-1}\n";

inline const std::string log_file =
    "unit: {id: 1}\n"
    "source: {kind: log, file: data.csv}\n"
    "lanes: [{name: a}]\n"
    "voters: [{name: voter-1}]\n";

inline const std::string ros2_file =
    "unit: {id: 1}\n"
    "source:\n"
    "  kind: ros2_imu\n"
    "  noise_rad: 1.0e-5\n"
    "  imus: [{topic: /a, name: front}, {topic: /b, name: rear}, {topic: /c}]\n"
    "lanes: [{name: a}]\n"
    "voters: [{name: voter-1}]\n";

inline const std::string accelerometer_file =
    "unit: {id: 1, kind: accelerometer, layout: cone-6}\n"
    "source: {noise_rad: 1.0e-3}\n"
    "lanes: [{name: a, detector: {method: glt}}]\n";

inline const std::string vessel_file =
    "unit: {id: 1, kind: vessel_rates}\n"
    "source: {noise: 1.0e-4}\n"
    "lanes: [{name: a, detector: {poles: [[-3, -4]]}}]\n";

/// A file that lives as long as this object.
class TemporaryFile {
public:
    explicit TemporaryFile(const std::string& text, const std::string& name = "system.yaml")
    {
        std::filesystem::create_directories(folder_);
        std::ofstream(path() / name, std::ios::binary) << text;
        file_ = (path() / name).string();
    }
    ~TemporaryFile() { std::filesystem::remove_all(folder_); }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    const std::string& name() const { return file_; }
    const std::filesystem::path& path() const { return folder_; }

private:
    static inline int count = 0;
    std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("quorient-file-" + std::to_string(::getpid()) + "-" + std::to_string(++count));
    std::string file_;
};

inline tl::expected<System, std::string> loaded(const std::string& text, const Overrides& overrides = {})
{
    const TemporaryFile file(text);
    return load(file.name(), overrides);
}

/// What a file is refused for, without the name of its folder; "accepted" if it is not.
inline std::string refusal(const std::string& text, const Overrides& overrides = {})
{
    const TemporaryFile file(text);
    const auto system = load(file.name(), overrides);
    if (system) return "accepted";
    std::string error = system.error();
    const std::string folder = file.path().string() + "/";
    for (auto place = error.find(folder); place != std::string::npos; place = error.find(folder)) error.erase(place, folder.size());
    return error;
}

/// A copy of a text with the first of some words changed.
inline std::string with(std::string text, const std::string& from, const std::string& to)
{
    const auto place = text.find(from);
    return place == std::string::npos ? "nothing to replace: " + from : text.replace(place, from.size(), to);
}

}  // namespace quorient::system
