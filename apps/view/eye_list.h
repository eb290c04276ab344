#pragma once
// Lists in panels of which each item can be hidden without being lost.

#include <vector>

namespace freevoxels {

/// An item that is not drawn while its eye is closed.
template <typename Item>
struct WithEye {
  Item item;
  bool isShown = true;
};

template <typename Item>
std::vector<Item> shownOf(const std::vector<WithEye<Item>>& list) {
  std::vector<Item> shown;
  for (const WithEye<Item>& entry : list)
    if (entry.isShown) shown.push_back(entry.item);
  return shown;
}

}  // namespace freevoxels
