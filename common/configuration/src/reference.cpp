#include "quorient/configuration/reference.hpp"

#include "quorient/configuration/suggestion.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <set>
#include <vector>

namespace quorient::configuration {

namespace {

/// As Markdown makes it of a heading.
std::string anchor_of(const std::string& heading)
{
    std::string anchor;
    for (const char letter : heading)
        if (std::isalnum(static_cast<unsigned char>(letter)) || letter == '_' || letter == '-')
            anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    return anchor;
}

std::string name_beneath(const std::string& mapping, const Key& key)
{
    const auto own = key.form == "list of mappings" ? key.name + "[]" : key.name;
    return mapping.empty() ? own : mapping + "." + own;
}

std::string otherwise_text(const Key& key)
{
    if (key.required) return "must be given";
    return key.otherwise.empty() ? "" : key.otherwise;
}

enum class Style { page, terminal };

std::string row_of(const Key& key, const std::string& mapping)
{
    const auto below = name_beneath(mapping, key);
    const auto value = key.parts.empty() ? value_text(key) : fmt::format("{}: [{}](#{})", key.form, below, anchor_of(below));
    return fmt::format("| `{}` | {} | {} | {} |\n", key.name, value, otherwise_text(key), key.sentence);
}

std::string lines_of(const Key& key)
{
    const auto left_out = otherwise_text(key);
    return fmt::format("{}: {}{}{}\n    {}\n", key.name, value_text(key),
                       left_out.empty() ? ""
                       : key.required   ? "; "
                                        : "; left out: ",
                       left_out, key.sentence);
}

std::string keys_text(const std::vector<Key>& keys, const std::string& mapping, Style style)
{
    if (keys.empty()) return {};
    std::string text = style == Style::page ? "\n| key | value | left out | what it does |\n|---|---|---|---|\n" : "";
    for (const auto& key : keys) text += style == Style::page ? row_of(key, mapping) : lines_of(key);
    return text;
}

/// One mapping, then those beneath it.
class Writer {
public:
    explicit Writer(Style style) : style_(style) {}

    void chapter(const Chapter& chapter, const std::string& heading, const std::string& mapping)
    {
        const bool page = style_ == Style::page;
        text_ += fmt::format("{}{}{}\n{}{}\n", text_.empty() && !page ? "" : "\n", page ? "## " : "", heading, page ? "\n" : "",
                             chapter.sentence);
        text_ += keys_text(chapter.keys, mapping, style_);
        for (const auto& variant : chapter.variants) {
            text_ += fmt::format(fmt::runtime(page ? "\n**With `{}`:** {}\n" : "With {}: {}\n"), variant.when, variant.sentence);
            text_ += keys_text(variant.keys, mapping, style_);
        }
        parts(chapter.keys, mapping);
        for (const auto& variant : chapter.variants) parts(variant.keys, mapping);
    }

    const std::string& text() const { return text_; }

private:
    void parts(const std::vector<Key>& keys, const std::string& mapping)
    {
        for (const auto& key : keys)
            for (const auto& part : key.parts)
                if (const auto below = name_beneath(mapping, key); written_.insert(below).second) chapter(part, below, below);
    }

    Style style_;
    std::string text_;
    std::set<std::string> written_;
};

std::vector<const Key*> keys_called(const Chapter& chapter, std::string_view name)
{
    std::vector<const Key*> found;
    for (const auto& key : chapter.keys)
        if (key.name == name) found.push_back(&key);
    for (const auto& variant : chapter.variants)
        for (const auto& key : variant.keys)
            if (key.name == name) found.push_back(&key);
    return found;
}

}  // namespace

std::string value_text(const Key& key)
{
    if (!key.words.empty()) return (key.words.size() == 1 ? "" : "one of ") + listed(key.words);
    const auto bounds = key.bounds ? key.bounds->text() : std::string{};
    return key.form + (bounds.empty() ? "" : ", " + bounds) + (key.unit.empty() ? "" : fmt::format(" [{}]", key.unit));
}

std::string reference(const Chapter& chapter, const std::string& name)
{
    Writer writer(Style::page);
    writer.chapter(chapter, name, "");
    return writer.text();
}

std::string explanation(const Chapter& chapter, const std::string& name)
{
    Writer writer(Style::terminal);
    writer.chapter(chapter, name, "");
    return writer.text();
}

std::optional<std::string> explanation_of(const Chapter& chapter, std::string_view path)
{
    const auto dot = path.find('.');
    std::string text;
    for (const auto* key : keys_called(chapter, path.substr(0, dot))) {
        if (dot == std::string_view::npos) text += lines_of(*key);
        for (const auto& part : key->parts) {
            if (dot == std::string_view::npos) text += "\n" + explanation(part, key->name);
            else text += explanation_of(part, path.substr(dot + 1)).value_or("");
        }
    }
    return text.empty() ? std::nullopt : std::optional(text);
}

}  // namespace quorient::configuration
