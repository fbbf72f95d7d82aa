#pragma once

#include "quorient/settings/bounds.hpp"

#include <optional>
#include <string>
#include <vector>

namespace quorient::configuration {

struct Chapter;

/// What there is to know about one key of a file, apart from how it is read.
struct Key {
    std::string name;
    std::string form{};  ///< "number", "list of numbers", "mapping", …
    std::string unit{};
    std::optional<settings::Bounds> bounds{};  ///< for a number, or for each number of a list
    std::vector<std::string> words{};          ///< that may stand, where there are only a few
    std::string otherwise{};                   ///< what holds where the key is left out
    std::string sentence{};                    ///< what it does
    bool required = false;
    bool hidden = false;           ///< not on the reference page: it exists to be refused
    bool inherited = false;        ///< where it is left out, that of the whole file holds
    std::vector<Chapter> parts{};  ///< the keys of this mapping, or of each mapping of this list
};

/// The keys of one mapping.
struct Chapter {
    std::string when{};  ///< "kind: log"; empty: always
    std::string sentence{};
    std::vector<Key> keys{};
    std::vector<Chapter> variants{};  ///< further keys of the same mapping, of which one chapter holds
};

}  // namespace quorient::configuration
