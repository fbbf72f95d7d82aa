#pragma once

#include "quorient/security/authority.hpp"
#include "quorient/system/system.hpp"

#include <string>
#include <vector>

namespace quorient::system {

/// Identity of the verbs that publish orders, and of a web monitor that may.
inline const std::string operator_name = "operator";

/// The identities that a system needs: one for each process, with the topics of its role and of ROS 2; `monitor` for `quorient launch`,
/// the web monitor and the verbs that only subscribe; `operator` for the verbs that publish orders.
std::vector<security::Member> members_of(const System& system);

}  // namespace quorient::system
