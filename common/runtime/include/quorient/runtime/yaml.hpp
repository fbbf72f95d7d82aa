#pragma once

#include <yaml-cpp/yaml.h>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace quorient::runtime {

/// All that is wrong with a file, each with its place; collected so that a user mends everything at once.
class Problems {
public:
    explicit Problems(std::string file) : file_(std::move(file)) {}

    void add(const YAML::Mark& mark, std::string_view what);
    void add(std::string_view what);

    bool empty() const { return lines_.empty(); }

    /// One line per problem in the order of the file, then how many.
    std::string text() const;

private:
    struct Line {
        int line;
        int column;
        std::string text;
    };
    std::string file_;
    std::vector<Line> lines_;
};

/// Bounds of a number and the unit that messages name.
struct Bounds {
    double lowest = -std::numeric_limits<double>::infinity();
    double highest = std::numeric_limits<double>::infinity();
    bool lowest_included = true;
    std::string_view unit{};
};
inline constexpr Bounds any_number{};
inline constexpr Bounds not_negative{.lowest = 0};
inline constexpr Bounds above_zero{.lowest = 0, .lowest_included = false};
inline constexpr Bounds probability{.lowest = 0, .highest = 1, .lowest_included = false};

/// A mapping of a YAML file. Every key is asked for by name; finish() reports the keys that nobody asked for.
class Section {
public:
    /// @param path  how messages name this mapping, e.g. "lanes[1].detector"; empty for the file itself.
    Section(YAML::Node node, std::string path, Problems& problems);

    bool has(const char* key);

    // A value of the wrong form, or out of bounds, is a problem and leaves `value` as it was. An absent key does too, silently.
    void number(const char* key, double& value, const Bounds& bounds = any_number);
    void number(const char* key, std::optional<double>& value, const Bounds& bounds = any_number);
    void whole(const char* key, std::uint32_t& value, std::uint32_t lowest = 0,
               std::uint32_t highest = std::numeric_limits<std::uint32_t>::max());
    void whole(const char* key, std::uint64_t& value);
    void whole(const char* key, std::optional<unsigned>& value);
    void text(const char* key, std::string& value);
    void boolean(const char* key, bool& value);
    void numbers(const char* key, std::vector<double>& value, const Bounds& bounds = any_number);
    void texts(const char* key, std::vector<std::string>& value);

    /// A key that must be there.
    void require(const char* key);

    /// The mapping under a key; an empty one if the key is absent.
    Section section(const char* key);

    /// The mappings of a list under a key.
    std::vector<Section> sections(const char* key);

    /// The raw value under a key, for what has a form of its own.
    YAML::Node raw(const char* key);

    /// A problem with the value of a key.
    void problem(const char* key, std::string_view what);

    void finish();

    /// "lanes[1].detector.method"
    std::string name_of(std::string_view key) const;

private:
    YAML::Node find(const char* key);

    YAML::Node node_;
    std::string path_;
    Problems* problems_;
    std::vector<std::string> asked_;
};

/// Sets one value of a document: `a.b=value`, or `a.b+=value` to append to a list. The value is YAML; `null` takes a key out.
/// @returns an error for text that is no assignment.
tl::expected<void, std::string> assign(YAML::Node document, const std::string& assignment);

/// Reads a YAML file whose root is a mapping. @returns file:line:column and what, for a file that cannot be read or parsed.
tl::expected<YAML::Node, std::string> load_yaml(const std::string& file);

}  // namespace quorient::runtime
