#pragma once

namespace quorient::composition {

/// main() of `quorient-run`: services of one host in one process, on one bus and one event loop.
/// @returns the exit code, as host::run().
int run(int argc, char** argv);

}  // namespace quorient::composition
