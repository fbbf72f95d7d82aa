#pragma once

#include "field_trial.hpp"

#include "quorient/messages/cluster_description.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace quorient::studies {

struct LogFigures {
    std::string name;
    std::size_t instruments = 0;
    double duration_s = 0;
    ClusterDescription description;
    SoundRun run;
};

struct FaultFigures {
    FieldFault fault;
    std::vector<FaultRun> runs;
};

/// Among the finite values; infinite where there is none.
inline double quantile(std::vector<double> values, double share)
{
    std::erase_if(values, [](double value) { return !std::isfinite(value); });
    if (values.empty()) return FaultRun::never_s;
    std::ranges::sort(values);
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

template <class Figure>
std::vector<double> each(const FaultFigures& figures, Figure figure)
{
    std::vector<double> values;
    for (const FaultRun& run : figures.runs) values.push_back(figure(run));
    return values;
}

template <class Predicate>
double percent(const FaultFigures& figures, Predicate predicate)
{
    const auto count = std::ranges::count_if(figures.runs, predicate);
    return figures.runs.empty() ? 0 : 100.0 * static_cast<double>(count) / static_cast<double>(figures.runs.size());
}

inline bool latched(const FaultRun& run)
{
    return std::isfinite(run.latched_s);
}

}  // namespace quorient::studies
