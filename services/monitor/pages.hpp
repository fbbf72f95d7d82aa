#pragma once

#include <string_view>
#include <vector>

namespace quorient::monitor {

/// A file of the page, compiled in.
struct Page {
    std::string_view path;  ///< as the browser asks for it
    std::string_view type;
    std::string_view text;
};

const std::vector<Page>& pages();

}  // namespace quorient::monitor
