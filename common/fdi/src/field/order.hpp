#pragma once

#include <cstddef>

namespace quorient::fdi::field {

/// Ascending; for the few values of an array.
inline void sort(double* values, std::size_t count)
{
    for (std::size_t i = 1; i < count; ++i) {
        const double value = values[i];
        std::size_t place = i;
        for (; place > 0 && values[place - 1] > value; --place) values[place] = values[place - 1];
        values[place] = value;
    }
}

/// The median of one value or more, which it sorts.
inline double median(double* values, std::size_t count)
{
    sort(values, count);
    return count % 2 == 1 ? values[count / 2] : (values[count / 2 - 1] + values[count / 2]) / 2;
}

}  // namespace quorient::fdi::field
