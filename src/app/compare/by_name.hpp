#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace eigengrain::app {

/// Collects by name, in the order in which names are met.
template <class Item>
class ByName {
 public:
  Item& of(const std::string& name) {
    const auto [place, is_new] = index_.try_emplace(name, items.size());
    if (is_new) items.emplace_back();
    return items[place->second];
  }
  std::vector<Item> items;

 private:
  std::map<std::string, std::size_t> index_;
};

/// Not a number of none.
double median_of(std::vector<double> values);

}  // namespace eigengrain::app
