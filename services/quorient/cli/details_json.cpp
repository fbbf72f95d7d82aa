#include "details_json.hpp"

#include <type_traits>

namespace quorient::cli {
namespace {

struct ToJson {
    Json operator()(std::monostate) const { return nullptr; }
    Json operator()(bool value) const { return value; }
    Json operator()(std::int64_t value) const { return value; }
    Json operator()(double value) const { return value; }
    Json operator()(const std::string& text) const { return text.empty() ? Json(nullptr) : Json(text); }
    Json operator()(const fdi::Detail::Axes& axes) const { return axes_json(axes.mask); }
    Json operator()(const fdi::Detail::Interval& interval) const { return Json::array({interval[0], interval[1]}); }
    Json operator()(const fdi::ScoredSet& set) const { return {{"axes", axes_json(set.axes)}, {"score", set.score}}; }

    template <class Element>
    Json operator()(const std::vector<Element>& list) const
    {
        Json array = Json::array();
        for (const Element& element : list) array.push_back((*this)(element));
        return array;
    }

    Json operator()(const std::vector<bool>& list) const
    {
        Json array = Json::array();
        for (const bool element : list) array.push_back(element);
        return array;
    }
};

}  // namespace

Json json_of(const fdi::Detail::Value& value)
{
    return std::visit(ToJson{}, value);
}

}  // namespace quorient::cli
