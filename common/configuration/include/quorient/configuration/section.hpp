#pragma once

#include "quorient/configuration/problems.hpp"
#include "quorient/settings/bounds.hpp"

#include <yaml-cpp/yaml.h>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace quorient::configuration {

using settings::Bounds;

/// A mapping of a YAML file. Every key is asked for by name; finish() reports the keys that were not asked for, and the constructor those
/// that stand there twice.
class Section {
public:
    /// @param path  how messages name this mapping, e.g. "lanes[1].detector"; empty for the file itself.
    Section(YAML::Node node, std::string path, Problems& problems);

    /// Whether the key stands there with a value; `key: null` does not count.
    bool has(std::string_view key);

    // A value of the wrong form, or out of bounds, is a problem and leaves `value` as it was. An absent key does too, silently.
    void number(std::string_view key, double& value, const Bounds& bounds = {}, std::string_view unit = {});
    void number(std::string_view key, std::optional<double>& value, const Bounds& bounds = {}, std::string_view unit = {});
    void whole(std::string_view key, std::uint32_t& value, const Bounds& bounds = {}, std::string_view unit = {});
    void whole(std::string_view key, std::optional<std::uint32_t>& value, const Bounds& bounds = {}, std::string_view unit = {});
    void whole(std::string_view key, std::uint64_t& value, const Bounds& bounds = {}, std::string_view unit = {});
    void text(std::string_view key, std::string& value);
    void boolean(std::string_view key, bool& value);
    void numbers(std::string_view key, std::vector<double>& value, const Bounds& bounds = {});
    void wholes(std::string_view key, std::vector<std::uint32_t>& value, const Bounds& bounds = {});
    void texts(std::string_view key, std::vector<std::string>& value);

    /// A key that must be there.
    void require(std::string_view key);

    /// The mapping under a key; an empty one if the key is absent.
    Section section(std::string_view key);

    /// The mappings of a list under a key.
    std::vector<Section> sections(std::string_view key);

    /// The raw value under a key, for what has a form of its own.
    YAML::Node raw(std::string_view key);

    /// A problem with the value of a key.
    void problem(std::string_view key, std::string_view what);

    /// A problem with one entry of the list under a key.
    void problem(std::string_view key, std::size_t entry, std::string_view what);

    void finish();

    /// So far, in the whole document.
    std::size_t problem_count() const;

    /// "lanes[1].detector.method"
    std::string name_of(std::string_view key) const;

private:
    YAML::Node find(std::string_view key);
    bool is_in_order(std::string_view key, std::optional<double> number, const YAML::Node& node, const Bounds& bounds,
                     std::string_view unit, std::string_view form);
    template <class Number>
    void read_list(std::string_view key, std::vector<Number>& value, const Bounds& bounds, std::string_view form);
    template <class Whole>
    void read_whole(std::string_view key, Whole& value, const Bounds& bounds, std::string_view unit);

    YAML::Node node_;
    std::string path_;
    Problems* problems_;
    std::vector<std::string> asked_;
};

}  // namespace quorient::configuration
