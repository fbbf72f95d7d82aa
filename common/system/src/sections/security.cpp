#include "security.hpp"

#include <string>
#include <utility>
#include <vector>

namespace quorient::system {

using namespace configuration;
using bus::SecurityLevel;
using runtime::OrderSettings;

namespace {

const std::vector<std::pair<std::string, SecurityLevel>>& level_words()
{
    static const std::vector<std::pair<std::string, SecurityLevel>> words = [] {
        std::vector<std::pair<std::string, SecurityLevel>> all;
        for (const auto level : {SecurityLevel::none, SecurityLevel::sign, SecurityLevel::encrypt})
            all.emplace_back(bus::to_string(level), level);
        return all;
    }();
    return words;
}

Rows<SecuritySettings> directory_row()
{
    const auto read = [](Section& section, SecuritySettings& security) { section.text("directory", security.directory); };
    const auto write = [](const SecuritySettings& security) {
        return security.directory.empty() ? YAML::Node{YAML::NodeType::Undefined} : to_node(security.directory);
    };
    return own<SecuritySettings>({.name = "directory",
                                  .form = "text",
                                  .otherwise = "none",
                                  .sentence = "Keys as `quorient keys` makes them; counts from the folder of the system file."},
                                 read, write);
}

/// A directory of keys is meant to be used: with it, `encrypt` is the default.
Rows<SecuritySettings> level_row()
{
    Key key{.name = "level",
            .form = "word",
            .otherwise = "none; with a `directory`, encrypt",
            .sentence = "`sign`: readable on the wire, cannot be forged; `encrypt`: neither. All processes have one level."};
    for (const auto& word : level_words()) key.words.push_back(word.first);
    const auto read = [key](Section& section, SecuritySettings& security) {
        if (const auto found = read_word(section, key, "level")) security.level = level_words()[*found].second;
        else if (section.has("directory") && security.level == SecurityLevel::none) security.level = SecurityLevel::encrypt;
    };
    return own<SecuritySettings>(key, read,
                                 [](const SecuritySettings& security) { return to_node(std::string{bus::to_string(security.level)}); });
}

Rows<OrderSettings> order_row(const std::string& name, bool OrderSettings::*member, const std::string& otherwise, const std::string& sentence)
{
    return word<OrderSettings, bool>({.name = name, .otherwise = otherwise, .sentence = sentence}, "word", member,
                                     {{"allowed", true}, {"refused", false}});
}

}  // namespace

Rows<ProcessSettings> security_row()
{
    static const Table<SecuritySettings> table{"DDS Security; not together with shared memory (docs/security.md).",
                                               {directory_row(), level_row()}};
    return part({.name = "security", .sentence = "DDS Security."}, &ProcessSettings::security, table);
}

const Table<OrderSettings>& commands_table()
{
    static const Table<OrderSettings> table{
        "Orders that the unit obeys.",
        {order_row("inject", &OrderSettings::inject, "allowed; refused for ros2_imu", "`quorient inject`, which breaks an axis on purpose."),
         order_row("readmit", &OrderSettings::readmit, "allowed", "`quorient readmit`."),
         order_row("reset", &OrderSettings::reset, "allowed", "`quorient reset`.")}};
    return table;
}

}  // namespace quorient::system
