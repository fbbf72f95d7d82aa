#include "quorient/attitude/update.hpp"

#include "polynomial_fit.hpp"

#include "block_update.hpp"
#include "classic_update.hpp"
#include "window_update.hpp"

#include <array>
#include <charconv>
#include <optional>
#include <utility>

namespace quorient::attitude {
namespace {

struct ClassicEntry {
    std::string_view name;
    ClassicRule rule;
    std::string_view equation;
    std::string_view source;
};

constexpr std::array classic_entries{
    ClassicEntry{"single", ClassicRule::single, "phi = th", "docs/methods/coning.md"},
    ClassicEntry{"previous", ClassicRule::previous, "phi = th + 1/12 th_previous x th", "docs/methods/coning.md; Savage 1998"},
    ClassicEntry{"two-sample", ClassicRule::two_sample, "phi = th1 + th2 + 2/3 th1 x th2", "docs/methods/coning.md; Miller 1983"},
    ClassicEntry{"three-sample", ClassicRule::three_sample, "phi = sum + (9/20 th1 + 27/20 th2) x th3",
                 "docs/methods/coning.md; Ignagni 1990"},
    ClassicEntry{"three-sample-miller", ClassicRule::three_sample_miller, "phi = sum + 9/20 th1 x th3 + 27/40 th2 x (th3 - th1)",
                 "Miller 1983"},
    ClassicEntry{"four-sample", ClassicRule::four_sample, "phi = sum + (54/105 th1 + 92/105 th2 + 214/105 th3) x th4",
                 "docs/methods/coning.md; Lee, Yoon and others 1990"},
};

// The N of "prefix-N", 1 .. longest_memory.
std::optional<std::size_t> order_after(std::string_view prefix, std::string_view name)
{
    if (!name.starts_with(prefix)) return std::nullopt;
    const std::string_view digits = name.substr(prefix.size());
    std::size_t order = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), order);
    if (error != std::errc() || end != digits.data() + digits.size() || order < 1 || order > longest_memory) return std::nullopt;
    return order;
}

}  // namespace

std::vector<UpdateEntry> update_catalogue()
{
    std::vector<UpdateEntry> entries;
    for (const auto& entry : classic_entries)
        entries.push_back({std::string(entry.name), std::string(entry.equation), std::string(entry.source)});
    const std::string equation = "q <- 1 + 1/2 integral of q o omega, omega the polynomial of degree N - 1 through N increments";
    entries.push_back({"block-N", equation + ", every N samples", "docs/methods/coning.md; Wu 2018"});
    entries.push_back({"window-N", equation + ", over the newest sample", "docs/methods/coning.md; Wu 2018"});
    return entries;
}

tl::expected<std::unique_ptr<const Update>, std::string> make_update(std::string_view name)
{
    equal_fit(1, 0);  // the tables are made now, not at the first sample
    for (const auto& entry : classic_entries)
        if (entry.name == name) return std::make_unique<const ClassicUpdate>(entry.rule);
    if (const auto order = order_after("window-", name)) return std::make_unique<const WindowUpdate>(*order);
    if (const auto order = order_after("block-", name)) return std::make_unique<const BlockUpdate>(*order);

    std::string message = "no update algorithm '" + std::string(name) + "'; there are";
    for (const auto& entry : update_catalogue()) message += " " + entry.name;
    return tl::unexpected(message + " (N = 1 .. " + std::to_string(longest_memory) + ")");
}

}  // namespace quorient::attitude
