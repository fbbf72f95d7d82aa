#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace quorient::diagnosis {

/// Keeps every item until there are too many, then every second, fourth … one: a log of any length in bounded memory.
template <class Item>
class Decimated {
public:
    explicit Decimated(std::size_t most) : most_(most) {}

    void add(Item item)
    {
        if (number_++ % stride_ != 0) return;
        items_.push_back(std::move(item));
        if (items_.size() <= most_) return;
        stride_ *= 2;
        std::size_t kept = 1;
        for (std::size_t i = 2; i < items_.size(); i += 2) items_[kept++] = std::move(items_[i]);
        items_.resize(kept);
    }

    const std::vector<Item>& items() const { return items_; }

private:
    std::size_t most_;
    std::size_t stride_ = 1;
    std::size_t number_ = 0;
    std::vector<Item> items_;
};

}  // namespace quorient::diagnosis
