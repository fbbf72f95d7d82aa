#pragma once

#include "quorient/messages/limits.hpp"

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <limits>
#include <optional>
#include <string>

namespace quorient::cli {

/// Keeps keys in the order in which they are set.
using Json = nlohmann::ordered_json;

/// A figure that does not exist: null in JSON, "-" in tables.
inline constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

/// One line of JSON: numbers with 17 significant digits, values that are not finite (or unset) as null.
std::string dump(const Json& value);

/// The axes of a mask, ascending: [1, 4].
Json axes_json(AxisMask mask);

/// Null where there is no value.
Json or_null(const std::optional<double>& value);

/// A vector as [..].
template <class Derived>
Json vector_json(const Eigen::DenseBase<Derived>& vector)
{
    Json list = Json::array();
    for (Eigen::Index k = 0; k < vector.size(); ++k) list.push_back(static_cast<double>(vector.derived().coeff(k)));
    return list;
}

/// A matrix as a list of its rows.
template <class Derived>
Json matrix_json(const Eigen::DenseBase<Derived>& matrix)
{
    Json list = Json::array();
    for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
        Json cells = Json::array();
        for (Eigen::Index column = 0; column < matrix.cols(); ++column)
            cells.push_back(static_cast<double>(matrix.derived().coeff(row, column)));
        list.push_back(std::move(cells));
    }
    return list;
}

}  // namespace quorient::cli
