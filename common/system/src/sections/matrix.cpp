#include "matrix.hpp"

#include "quorient/configuration/values.hpp"

#include <fmt/format.h>
#include <optional>
#include <vector>

namespace quorient::system {

using namespace configuration;

namespace {

bool is_list_of_rows(const YAML::Node& rows)
{
    return rows.IsSequence() && rows.size() > 0 && rows[0].IsSequence() && rows[0].size() > 0;
}

/// Infinities and NaN count: whoever uses the matrix refuses them by its name.
std::optional<double> number_of(const YAML::Node& node)
{
    double value = 0;
    return node.IsScalar() && YAML::convert<double>::decode(node, value) ? std::optional(value) : std::nullopt;
}

}  // namespace

bool read_matrix(Section& section, const std::string& key, Eigen::MatrixXd& matrix)
{
    if (!section.has(key)) return false;
    const YAML::Node rows = section.raw(key);
    if (!is_list_of_rows(rows)) {
        section.problem(key, "expected a list of rows, each a list of numbers");
        return false;
    }
    const std::size_t columns = rows[0].size();
    Eigen::MatrixXd read(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns));
    for (std::size_t row = 0; row < rows.size(); ++row) {
        if (!rows[row].IsSequence() || rows[row].size() != columns) {
            section.problem(key, fmt::format("row {} must have {} numbers like the first", row, columns));
            return false;
        }
        for (std::size_t column = 0; column < columns; ++column) {
            const auto value = number_of(rows[row][column]);
            if (!value) {
                section.problem(key, fmt::format("row {} column {} is not a number", row, column));
                return false;
            }
            read(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) = *value;
        }
    }
    matrix = read;
    return true;
}

YAML::Node matrix_node(const Eigen::Ref<const Eigen::MatrixXd>& matrix)
{
    YAML::Node rows{YAML::NodeType::Sequence};
    for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
        std::vector<double> values;
        for (Eigen::Index column = 0; column < matrix.cols(); ++column) values.push_back(matrix(row, column));
        rows.push_back(to_node(values));
    }
    rows.SetStyle(YAML::EmitterStyle::Flow);
    return rows;
}

}  // namespace quorient::system
