#include "column_name.hpp"

#include "table.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <span>

namespace quorient::recording::csv {
namespace {

using Words = std::vector<std::string>;

/// Lower-case words, and where each begins in the text.
struct PlacedWords {
    Words words;
    std::vector<std::size_t> begin;
};

bool is_letter(char c)
{
    return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

bool is_capital(char c)
{
    return std::isupper(static_cast<unsigned char>(c)) != 0;
}

/// Words and numbers: "IMU2_GyrX" -> imu 2 gyr x. A word ends where a capital follows a small letter, or a digit a letter.
PlacedWords words_of(std::string_view text)
{
    PlacedWords found;
    char before = ' ';
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        const bool letter = is_letter(c);
        if (letter || is_digit(c)) {
            const bool capital_after_small = is_capital(c) && is_letter(before) && !is_capital(before);
            const bool continues = letter ? is_letter(before) && !capital_after_small : is_digit(before);
            if (!continues) {
                found.words.emplace_back();
                found.begin.push_back(i);
            }
            found.words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        }
        before = c;
    }
    return found;
}

struct UnitWords {
    std::string_view words;  // joined by blanks
    std::string_view unit;
};

// What stands behind a name, longest first where one ends with another.
constexpr std::array unit_suffixes{
    UnitWords{"degrees per second", "deg/s"}, UnitWords{"deg per sec", "deg/s"},
    UnitWords{"radians per second", "rad/s"}, UnitWords{"rad per sec", "rad/s"},
    UnitWords{"rad per s", "rad/s"}, UnitWords{"rad s", "rad/s"},   UnitWords{"rads", "rad/s"},    UnitWords{"radps", "rad/s"},
    UnitWords{"mrad s", "mrad/s"},   UnitWords{"deg per s", "deg/s"}, UnitWords{"deg s", "deg/s"},  UnitWords{"degs", "deg/s"},
    UnitWords{"degps", "deg/s"},     UnitWords{"dps", "deg/s"},     UnitWords{"mdps", "mdeg/s"},   UnitWords{"mdeg s", "mdeg/s"},
    UnitWords{"rad", "rad"},         UnitWords{"deg", "deg"},       UnitWords{"m s 2", "m/s^2"},   UnitWords{"m s2", "m/s^2"},
    UnitWords{"ms 2", "m/s^2"},      UnitWords{"mps 2", "m/s^2"},   UnitWords{"m s s", "m/s^2"},   UnitWords{"s", "s"},
    UnitWords{"sec", "s"},           UnitWords{"secs", "s"},        UnitWords{"seconds", "s"},     UnitWords{"ms", "ms"},
    UnitWords{"msec", "ms"},         UnitWords{"milliseconds", "ms"}, UnitWords{"us", "us"},       UnitWords{"usec", "us"},
    UnitWords{"microseconds", "us"}, UnitWords{"ns", "ns"},         UnitWords{"nsec", "ns"},       UnitWords{"nsecs", "ns"},
    UnitWords{"nanosec", "ns"},      UnitWords{"nanoseconds", "ns"}};

/// A unit between brackets, however it is spelled. Empty: none that is known.
std::string unit_between_brackets(std::string_view text)
{
    std::string plain;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto rest = text.substr(i);
        if (rest.starts_with("\xC2\xB0") || rest.starts_with("\xC2\xBA")) plain += "deg", ++i;     // degree sign, and the ordinal taken for it
        else if (rest.starts_with("\xC2\xB5") || rest.starts_with("\xCE\xBC")) plain += "u", ++i;  // micro sign, Greek mu
        else if (text[i] == '\xB0' || text[i] == '\xBA') plain += "deg";                            // the same in Latin-1
        else if (text[i] == '\xB5') plain += "u";
        else if (text[i] != ' ' && text[i] != '*') plain += static_cast<char>(std::tolower(static_cast<unsigned char>(text[i])));
    }
    constexpr std::array known{UnitWords{"rad/s", "rad/s"},   UnitWords{"rads-1", "rad/s"}, UnitWords{"r/s", "rad/s"},    UnitWords{"rad/sec", "rad/s"},
                               UnitWords{"deg/s", "deg/s"},   UnitWords{"dps", "deg/s"},    UnitWords{"deg/sec", "deg/s"}, UnitWords{"degs-1", "deg/s"},
                               UnitWords{"degs^-1", "deg/s"}, UnitWords{"rads^-1", "rad/s"}, UnitWords{"degpers", "deg/s"}, UnitWords{"radpers", "rad/s"},
                               UnitWords{"degrees/s", "deg/s"}, UnitWords{"degree/s", "deg/s"}, UnitWords{"degrees/sec", "deg/s"}, UnitWords{"deg/second", "deg/s"},
                               UnitWords{"degrees/second", "deg/s"}, UnitWords{"radians/s", "rad/s"}, UnitWords{"rad/second", "rad/s"}, UnitWords{"radians/second", "rad/s"},
                               UnitWords{"mdps", "mdeg/s"},   UnitWords{"mdeg/s", "mdeg/s"}, UnitWords{"mrad/s", "mrad/s"}, UnitWords{"rad", "rad"},
                               UnitWords{"deg", "deg"},       UnitWords{"s", "s"},          UnitWords{"sec", "s"},        UnitWords{"ms", "ms"},
                               UnitWords{"us", "us"},         UnitWords{"ns", "ns"},        UnitWords{"g", "g"},           UnitWords{"mg", "mg"},
                               UnitWords{"m/s^2", "m/s^2"},   UnitWords{"m/s2", "m/s^2"},   UnitWords{"m/s/s", "m/s^2"},  UnitWords{"ms-2", "m/s^2"}};
    const auto* const found = std::find_if(known.begin(), known.end(), [&](const UnitWords& unit) { return unit.words == plain; });
    return found == known.end() ? std::string{} : std::string(found->unit);
}

/// Takes the last brackets off a name if a unit stands in them.
std::string take_bracketed_unit(std::string_view& text)
{
    if (!text.ends_with(']') && !text.ends_with(')')) return {};
    const std::size_t open = text.find_last_of(text.back() == ']' ? '[' : '(');
    if (open == std::string_view::npos) return {};
    auto unit = unit_between_brackets(text.substr(open + 1, text.size() - open - 2));
    if (!unit.empty()) text = trimmed(text.substr(0, open));
    return unit;
}

/// Takes brackets off a name if a unit of something else stands in them, as in "gx [rpm]".
std::string take_unknown_unit(std::string_view& text)
{
    if (!text.ends_with(']') && !text.ends_with(')')) return {};
    const std::size_t open = text.find_last_of(text.back() == ']' ? '[' : '(');
    if (open == std::string_view::npos) return {};
    const std::string_view unit = trimmed(text.substr(open + 1, text.size() - open - 2));
    constexpr std::array<std::string_view, 11> units{"rpm", "RPM", "rps", "Hz", "counts", "count", "LSB", "lsb", "raw", "digits", "%"};
    const bool is_unit = unit.find('/') != std::string_view::npos || std::find(units.begin(), units.end(), unit) != units.end();
    if (!is_unit) return {};
    text = trimmed(text.substr(0, open));
    return std::string(unit);
}

/// Takes words off the end if they are a unit.
std::string take_unit_words(Words& words)
{
    for (std::size_t count = std::min<std::size_t>(3, words.size()); count > 0; --count) {
        std::string last;
        for (std::size_t i = words.size() - count; i < words.size(); ++i) last += (last.empty() ? "" : " ") + words[i];
        const auto* const found = std::find_if(unit_suffixes.begin(), unit_suffixes.end(), [&](const UnitWords& unit) { return unit.words == last; });
        if (found == unit_suffixes.end()) continue;
        words.resize(words.size() - count);
        return std::string(found->unit);
    }
    return {};
}

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words)
{
    return std::find(words.begin(), words.end(), word) != words.end();
}

bool contains(const Words& words, std::initializer_list<std::string_view> wanted)
{
    return std::any_of(words.begin(), words.end(), [&](const std::string& word) { return is_one_of(word, wanted); });
}

bool is_rate_word(std::string_view word)
{
    return is_one_of(word, {"g", "gyr", "gyro", "gyros", "gyroscope", "w", "omega", "angvel", "rate", "rates", "adc", "drehrate"});
}

bool is_acceleration_word(std::string_view word)
{
    return is_one_of(word, {"a", "acc", "accel", "accelerometer", "acceleration"});
}

/// Several words that mean one quantity.
bool is_joint_word(const Words& words, std::size_t i)
{
    const auto at = [&](std::size_t place) { return place < words.size() ? std::string_view(words[place]) : std::string_view{}; };
    const std::string_view word = words[i];
    const std::string_view before = i > 0 ? std::string_view(words[i - 1]) : std::string_view{};
    if (is_one_of(word, {"angular", "ang"})) return is_one_of(at(i + 1), {"velocity", "vel", "rate"});
    if (word == "rotation") return at(i + 1) == "rate";
    return is_one_of(word, {"velocity", "vel", "rate"}) && is_one_of(before, {"angular", "ang", "rotation"});
}

/// "gx" and "xgyro" are two words in one.
void split_axis_words(Words& words)
{
    Words apart;
    for (const std::string& word : words) {
        const bool axis_last = word.size() >= 2 && word.back() >= 'x' && word.back() <= 'z';
        const bool axis_first = word.size() >= 2 && word.front() >= 'x' && word.front() <= 'z';
        const std::string head = word.substr(0, word.size() - 1);
        const std::string tail = word.substr(1);
        if (axis_last && (is_rate_word(head) || is_acceleration_word(head) || head == "dela" || head == "dtheta" || head == "increment")) {
            apart.push_back(head);
            apart.push_back(word.substr(word.size() - 1));
        } else if (axis_first && (is_rate_word(tail) || is_acceleration_word(tail))) {
            apart.push_back(word.substr(0, 1));
            apart.push_back(tail);
        } else {
            apart.push_back(word);
        }
    }
    words = std::move(apart);
}

bool any_word(const Words& words, bool (*test)(std::string_view))
{
    return std::any_of(words.begin(), words.end(), [&](const std::string& word) { return test(word); });
}

/// What a column holds that describes motion: rates, increments or accelerations.
std::optional<Quantity> motion_of(const Words& words)
{
    if (contains(words, {"covariance", "bias", "err", "unfilt", "setpoint", "euler", "orientation", "mag", "quat"})) return std::nullopt;
    if (contains(words, {"increment", "dtheta", "dela"})) return Quantity::increment;
    if (contains(words, {"delta"})) return contains(words, {"angle", "theta"}) ? std::optional(Quantity::increment) : std::nullopt;
    for (std::size_t i = 0; i < words.size(); ++i)
        if (is_joint_word(words, i)) return Quantity::rate;
    if (any_word(words, is_rate_word)) return Quantity::rate;
    if (any_word(words, is_acceleration_word)) return Quantity::acceleration;
    return std::nullopt;
}

/// "imu1_x" names an instrument and an axis, and no quantity.
bool is_instrument_axis(const Words& words)
{
    if (words.size() < 2 || !is_one_of(words.back(), {"x", "y", "z"})) return false;
    const auto is_instrument = [](const std::string& word) { return is_one_of(word, {"imu", "sensor", "device", "unit", "instance"}); };
    const auto end = words.end() - 1;
    return std::any_of(words.begin(), end, is_instrument) &&
           std::all_of(words.begin(), end, [&](const std::string& word) { return is_instrument(word) || is_digit(word[0]); });
}

/// @param alone  the name is one word, without an index
Quantity quantity_of(const Words& words, std::string_view unit, bool alone)
{
    if (alone && is_one_of(words[0], {"p", "q", "r", "x", "y", "z"}))
        return unit.empty() || unit.ends_with("/s") ? Quantity::rate : Quantity::other;
    if (is_instrument_axis(words)) return unit.empty() || unit.ends_with("/s") ? Quantity::rate : Quantity::other;
    if (contains(words, {"dt", "interval"})) return Quantity::interval;
    if (const auto motion = motion_of(words)) return *motion;
    if (contains(words, {"nanosec", "nsec", "nsecs"}) || (unit == "ns" && contains(words, {"stamp"}))) return Quantity::time_fraction;
    if (contains(words, {"time", "timestamp", "stamp", "ts", "t", "elapsed", "epoch", "zeit", "zeitstempel"})) return Quantity::time;
    if (contains(words, {"temp", "temperature"})) return Quantity::temperature;
    if (contains(words, {"counter", "seq"})) return Quantity::counter;
    const auto of_identity = [](std::string_view word) {
        return is_one_of(word, {"id", "i", "imu", "sensor", "instance", "device", "name", "no", "number"});
    };
    const bool identity = !words.empty() && std::all_of(words.begin(), words.end(), of_identity);
    return identity ? Quantity::identity : Quantity::other;
}

/// Takes a number off the end.
std::optional<std::size_t> take_index(Words& words)
{
    if (words.empty() || words.back().size() > 2 || !is_digit(words.back()[0])) return std::nullopt;
    const auto index = static_cast<std::size_t>(std::stoul(words.back()));
    words.pop_back();
    return index;
}

/// Takes the axis off the words: x, y, z; roll, pitch, yaw; or p, q, r that stand alone.
std::optional<std::size_t> take_axis(Words& words)
{
    constexpr std::array<std::array<std::string_view, 3>, 3> names{{{"x", "y", "z"}, {"roll", "pitch", "yaw"}, {"p", "q", "r"}}};
    for (std::size_t i = words.size(); i-- > 0;) {
        for (const auto& triple : names) {
            const auto* const found = std::find(triple.begin(), triple.end(), words[i]);
            if (found == triple.end() || (triple[0] == "p" && words.size() > 1)) continue;
            words.erase(words.begin() + static_cast<std::ptrdiff_t>(i));
            return static_cast<std::size_t>(found - triple.begin());
        }
    }
    return std::nullopt;
}

std::string owner_of(const Words& words, Quantity quantity)
{
    std::string owner;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const bool of_quantity = is_rate_word(words[i]) || is_acceleration_word(words[i]) || is_joint_word(words, i) ||
                                 is_one_of(words[i], {"linear", "time", "timestamp", "zeit", "zeitstempel", "stamp", "ts", "t", "sample", "temp", "temperature", "delta",
                                                      "angle", "increment", "dtheta", "dela", "dt", "interval", "integral"});
        if (of_quantity || quantity == Quantity::identity) continue;
        owner += (owner.empty() ? "" : " ") + words[i];
    }
    return owner;
}

int rank_of_time(const Words& words)
{
    if (contains(words, {"sample"})) return 4;  // SampleTimeFine, timestamp_sample
    if (contains(words, {"header", "stamp"})) return 3;
    if (contains(words, {"time", "timestamp", "zeit", "zeitstempel"})) return 2;
    return contains(words, {"t", "ts"}) ? 1 : 0;
}

std::string_view without_quotes(std::string_view cell)
{
    cell = trimmed(cell);
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = trimmed(cell.substr(1, cell.size() - 2));
    return cell;
}

}  // namespace

ColumnName read_column_name(std::string_view header_cell)
{
    std::string_view text = without_quotes(header_cell);
    while (text.starts_with('#') || text.starts_with('%')) text = trimmed(text.substr(1));
    ColumnName column;
    column.unit = take_bracketed_unit(text);
    if (column.unit.empty()) column.unknown_unit = take_unknown_unit(text);
    auto [words, begin] = words_of(text);
    const auto index = text.ends_with(']') ? take_index(words) : std::nullopt;
    if (index) text = text.substr(0, begin[words.size()]);
    const bool alone = words.size() == 1 && !index;
    const std::size_t with_unit = words.size();
    if (column.unit.empty() && !alone) column.unit = take_unit_words(words);
    if (words.size() < with_unit) text = text.substr(0, begin[words.size()]);
    column.text = text;
    split_axis_words(words);
    column.quantity = quantity_of(words, column.unit, alone);
    if (column.quantity == Quantity::time) column.rank = rank_of_time(words);
    if (column.quantity == Quantity::rate || column.quantity == Quantity::increment || column.quantity == Quantity::acceleration) {
        column.bare = (alone && words[0].size() == 1 && words[0][0] >= 'x') || is_instrument_axis(words);
        column.axis = index ? index : take_axis(words);
        if (!column.axis && column.quantity == Quantity::increment) column.axis = take_index(words);
        if (!column.axis) column.quantity = Quantity::other;
    }
    column.owner = owner_of(words, column.quantity);
    return column;
}

std::string common_name(const std::array<std::string, 3>& columns)
{
    const std::size_t shortest = std::min({columns[0].size(), columns[1].size(), columns[2].size()});
    std::size_t front = 0;
    while (front < shortest && columns[0][front] == columns[1][front] && columns[0][front] == columns[2][front]) ++front;
    std::size_t back = 0;
    while (front + back < shortest && columns[0][columns[0].size() - 1 - back] == columns[1][columns[1].size() - 1 - back] &&
           columns[0][columns[0].size() - 1 - back] == columns[2][columns[2].size() - 1 - back])
        ++back;
    const auto trim = [](std::string text) {
        const auto separator = [](char c) { return !is_letter(c) && !is_digit(c) && c != ']' && c != ')'; };
        while (!text.empty() && separator(text.back())) text.pop_back();
        return text;
    };
    const std::string tail = trim(columns[0].substr(columns[0].size() - back));
    const std::string name = trim(columns[0].substr(0, front)) + tail;
    // A quantity behind the name says nothing: imu1/gyro is imu1. Before a number it is the name: g0.
    Words words = words_of(name).words;
    split_axis_words(words);
    if (owner_of(words, Quantity::rate).empty()) return {};
    if (!tail.empty()) return name;
    for (const std::string_view word : {"angular_velocity", "angular velocity", "AngularVelocity", "gyroscope", "Gyroscope", "gyro", "Gyro", "GYRO",
                                        "Gyr", "gyr", "GYR", "omega", "_g"}) {
        if (!name.ends_with(word) || name.size() == word.size()) continue;
        return trim(name.substr(0, name.size() - word.size()));
    }
    return name;
}

}  // namespace quorient::recording::csv
