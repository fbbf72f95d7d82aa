#pragma once

#include "quorient/configuration/key.hpp"
#include "quorient/configuration/section.hpp"
#include "quorient/configuration/values.hpp"
#include "quorient/settings/setting.hpp"

#include <functional>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace quorient::configuration {

/// One key of a mapping that is read into an `Owner`: what it is called and means, how it is read, and how it is written again.
template <class Owner>
struct Row {
    Key key;
    std::function<void(Section&, Owner&)> read;
    /// @param parent  the mapping that is being written. @returns undefined where the key is left out.
    std::function<YAML::Node(const Owner&, const YAML::Node& parent)> write;
};

template <class Owner>
using Rows = std::vector<Row<Owner>>;

/// Further rows of a mapping that hold under a condition on the rows before.
template <class Owner>
struct Variant {
    std::string when;  ///< the condition as a reader sees it: "kind: log"
    std::string sentence;
    std::function<bool(const Owner&)> holds;
    Rows<Owner> rows;
};

/// All rows of one mapping: the one place where its keys are stated.
template <class Owner>
class Table {
public:
    Table(std::string sentence, std::initializer_list<Rows<Owner>> groups, std::vector<Variant<Owner>> variants = {})
        : sentence_(std::move(sentence)), variants_(std::move(variants))
    {
        for (const auto& group : groups) rows_.insert(rows_.end(), group.begin(), group.end());
    }

    const Rows<Owner>& rows() const { return rows_; }

    /// Reads every key; what is wrong, and keys that are not in the table, become problems of the section.
    void read(Section& section, Owner& values) const
    {
        read_rows(rows_, section, values);
        if (const auto* variant = variant_of(values)) read_rows(variant->rows, section, values);
        section.finish();
    }

    /// All keys as read() takes them; of inherited keys, those whose value is not the parent's.
    YAML::Node write(const Owner& values, const YAML::Node& parent = {}) const
    {
        YAML::Node node{YAML::NodeType::Map};
        write_rows(rows_, values, parent, node);
        if (const auto* variant = variant_of(values)) write_rows(variant->rows, values, parent, node);
        return node;
    }

    Chapter chapter() const
    {
        Chapter chapter{.sentence = sentence_, .keys = keys_of(rows_)};
        for (const auto& variant : variants_)
            chapter.variants.push_back({.when = variant.when, .sentence = variant.sentence, .keys = keys_of(variant.rows)});
        return chapter;
    }

private:
    const Variant<Owner>* variant_of(const Owner& values) const
    {
        for (const auto& variant : variants_)
            if (variant.holds(values)) return &variant;
        return nullptr;
    }

    static void read_rows(const Rows<Owner>& rows, Section& section, Owner& values)
    {
        for (const auto& row : rows) {
            if (row.key.required) section.require(row.key.name);
            row.read(section, values);
        }
    }

    static void write_rows(const Rows<Owner>& rows, const Owner& values, const YAML::Node& parent, YAML::Node& node)
    {
        for (const auto& row : rows) {
            const auto value = row.write(values, node);
            if (!value.IsDefined() || (row.key.inherited && is_same(value, parent, row.key.name))) continue;
            node[row.key.name] = value;
        }
    }

    static std::vector<Key> keys_of(const Rows<Owner>& rows)
    {
        std::vector<Key> keys;
        for (const auto& row : rows)
            if (!row.key.hidden) keys.push_back(row.key);
        return keys;
    }

    std::string sentence_;
    Rows<Owner> rows_;
    std::vector<Variant<Owner>> variants_;
};

/// A row whose value has a form of its own. @param key  with name, form, sentence and, where no value stands for it, `otherwise`.
template <class Owner>
Rows<Owner> own(Key key, std::function<void(Section&, Owner&)> read, std::function<YAML::Node(const Owner&)> write)
{
    if (key.otherwise.empty()) key.otherwise = shown(write(Owner{}));
    return {Row<Owner>{std::move(key), std::move(read), [write](const Owner& values, const YAML::Node&) { return write(values); }}};
}

/// A number, a list of them, a text, a list of them, or a truth value: whatever Section reads into such a member.
template <class Owner, class Value>
Rows<Owner> value(Key key, Value Owner::*member)
{
    if (key.form.empty()) key.form = form_of(Value{});
    const auto read = [key, member](Section& section, Owner& values) { read_value(section, key, values.*member); };
    return own<Owner>(key, read, [member](const Owner& values) { return to_node(values.*member); });
}

/// The settings of a struct by its record.
template <class Owner>
Rows<Owner> record(settings::Record<Owner> record)
{
    Rows<Owner> rows;
    for (const auto& setting : record) {
        const Key key{.name = std::string{setting.key},
                      .unit = std::string{setting.unit},
                      .bounds = setting.bounds,
                      .otherwise = std::string{setting.otherwise},
                      .sentence = std::string{setting.sentence}};
        const auto added = std::visit([&](auto member) { return value<Owner>(key, member); }, setting.member);
        rows.insert(rows.end(), added.begin(), added.end());
    }
    return rows;
}

/// One of a few words. @param noun  what messages call it: "unknown scheme 'x'; there are directional and blind"
template <class Owner, class Enum>
Rows<Owner> word(Key key, const std::string& noun, Enum Owner::*member, std::vector<std::pair<std::string, Enum>> words)
{
    key.form = "word";
    for (const auto& entry : words) key.words.push_back(entry.first);
    const auto read = [key, noun, member, words](Section& section, Owner& values) {
        if (const auto found = read_word(section, key, noun)) values.*member = words[*found].second;
    };
    const auto write = [member, words](const Owner& values) {
        for (const auto& [text, code] : words)
            if (code == values.*member) return to_node(text);
        return YAML::Node{YAML::NodeType::Undefined};
    };
    return own<Owner>(key, read, write);
}

/// A mapping with a table of its own. @param prepare  sets what its keys need of those before it
template <class Owner, class Part>
Rows<Owner> part(Key key, Part Owner::*member, const Table<Part>& table, std::function<void(const Owner&, Part&)> prepare = {})
{
    key.form = "mapping";
    key.parts = {table.chapter()};
    const auto read = [key, member, table, prepare](Section& section, Owner& values) {
        if (prepare) prepare(values, values.*member);
        auto inner = section.section(key.name);
        table.read(inner, values.*member);
    };
    return {Row<Owner>{key, read,
                       [member, table](const Owner& values, const YAML::Node& parent) { return table.write(values.*member, parent); }}};
}

/// A mapping that may be absent. @param prepare  sets what its keys need of those before it
template <class Owner, class Part>
Rows<Owner> part(Key key, std::optional<Part> Owner::*member, const Table<Part>& table,
                 std::function<void(const Owner&, Part&)> prepare = {})
{
    key.form = "mapping";
    key.parts = {table.chapter()};
    const auto read = [key, member, table, prepare](Section& section, Owner& values) {
        if (!section.has(key.name)) return;
        auto& present = (values.*member).emplace();
        if (prepare) prepare(values, present);
        auto inner = section.section(key.name);
        table.read(inner, present);
    };
    const auto write = [member, table](const Owner& values, const YAML::Node& parent) {
        return values.*member ? table.write(*(values.*member), parent) : YAML::Node{YAML::NodeType::Undefined};
    };
    return {Row<Owner>{key, read, write}};
}

/// A list of mappings. @param prepare  sets what an item has before its keys are read; its place counts from 0
template <class Owner, class Item>
Rows<Owner> list(Key key, std::vector<Item> Owner::*member, const Table<Item>& table, std::size_t most,
                 std::function<void(const Owner&, Item&, std::size_t place)> prepare = {})
{
    key.form = "list of mappings";
    key.parts = {table.chapter()};
    const auto read = [key, member, table, most, prepare](Section& section, Owner& values) {
        auto items = section.sections(key.name);
        if (items.size() > most) section.problem(key.name, too_many(key.name, most, items.size()));
        for (std::size_t place = 0; place < std::min(items.size(), most); ++place) {
            auto& item = (values.*member).emplace_back();
            if (prepare) prepare(values, item, place);
            table.read(items[place], item);
        }
    };
    const auto write = [member, table](const Owner& values, const YAML::Node& parent) {
        YAML::Node node{YAML::NodeType::Sequence};
        for (const auto& item : values.*member) node.push_back(table.write(item, parent));
        return node;
    };
    return {Row<Owner>{key, read, write}};
}

/// The rows of a member, among those of its owner.
template <class Owner, class Part>
Rows<Owner> all_of(Part Owner::*member, const Rows<Part>& rows)
{
    Rows<Owner> result;
    for (const auto& row : rows)
        result.push_back({row.key, [row, member](Section& section, Owner& values) { row.read(section, values.*member); },
                          [row, member](const Owner& values, const YAML::Node& parent) { return row.write(values.*member, parent); }});
    return result;
}

/// The rows with these keys, in this order.
template <class Owner>
Rows<Owner> chosen(const Rows<Owner>& rows, std::initializer_list<std::string_view> keys)
{
    Rows<Owner> result;
    for (const auto key : keys)
        for (const auto& row : rows)
            if (row.key.name == key) result.push_back(row);
    return result;
}

/// Keys that would be taken for typing errors elsewhere, and deserve a reason here.
template <class Owner>
Rows<Owner> refused(const std::vector<std::string>& keys, std::function<std::string(const Owner&)> why)
{
    Rows<Owner> rows;
    for (const auto& key : keys) {
        const auto read = [key, why](Section& section, Owner& values) {
            if (section.has(key)) section.problem(key, why(values));
        };
        rows.push_back(
            {{.name = key, .hidden = true}, read, [](const Owner&, const YAML::Node&) { return YAML::Node{YAML::NodeType::Undefined}; }});
    }
    return rows;
}

/// A key that may stand there and is not looked at.
template <class Owner>
Rows<Owner> passed_over(Key key)
{
    key.form = "anything";
    key.otherwise = "nothing";
    const auto read = [name = key.name](Section& section, Owner&) { section.raw(name); };
    return {Row<Owner>{key, read, [](const Owner&, const YAML::Node&) { return YAML::Node{YAML::NodeType::Undefined}; }}};
}

/// These keys must stand there.
template <class Owner>
Rows<Owner> required(Rows<Owner> rows)
{
    for (auto& row : rows) row.key.required = true;
    return rows;
}

/// Where these keys are left out, those of the whole file hold.
template <class Owner>
Rows<Owner> inherited(Rows<Owner> rows)
{
    for (auto& row : rows) {
        row.key.inherited = true;
        row.key.otherwise = "as the whole file";
    }
    return rows;
}

}  // namespace quorient::configuration
