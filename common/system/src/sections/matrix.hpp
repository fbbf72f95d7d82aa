#pragma once

#include "quorient/configuration/section.hpp"

#include <Eigen/Core>
#include <string>

namespace quorient::system {

/// `[[1, 2], [3, 4]]`: rows of numbers, all of one length. What is wrong becomes a problem of the key.
/// @returns whether the matrix is there and was read.
bool read_matrix(configuration::Section& section, const std::string& key, Eigen::MatrixXd& matrix);

YAML::Node matrix_node(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

}  // namespace quorient::system
