#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace quorient::bus {

/// The IPv4 addresses of this host's interface `which`: its name, its own address, or the base address of its subnet
/// (containers know their subnets, not their interfaces' names). Empty where there is none.
std::vector<std::string> addresses_of(std::string_view which);

/// Whether the interface, as addresses_of() takes it, is this host's loopback.
bool is_loopback(std::string_view interface);

/// This host's IPv4 addresses except loopback, in ascending order. The kernel's order differs from start to start if two networks come up
/// together, as in a container.
std::vector<std::string> own_addresses();

/// The names of all interfaces that have an IPv4 address.
std::vector<std::string> interface_names();

bool is_ipv4_address(const std::string& text);

}  // namespace quorient::bus
