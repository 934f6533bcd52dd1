#include "schemes/rooted_trees.hpp"

#include <map>
#include <mutex>

namespace fw::schemes {

namespace {

/// Lists kept for the life of the program, one per key.
template <class Key, class List, class Make>
const List& remembered(std::map<Key, List>& lists, std::mutex& mutex, const Key& key, Make make) {
  const std::lock_guard lock(mutex);
  auto found = lists.find(key);
  if (found == lists.end()) found = lists.emplace(key, make()).first;
  return found->second;  // nodes of a map stay where they are
}

/// Calls `sink(chosen)` for every multiset of places with the given weights that sums to `remaining`; places
/// are not decreasing. `weight[p]` is what place p adds.
template <class Sink>
void for_each_multiset(const std::vector<int>& weight, int remaining, std::size_t from,
                       std::vector<int>& chosen, const Sink& sink) {
  if (remaining == 0) {
    sink(chosen);
    return;
  }
  for (std::size_t place = from; place < weight.size(); ++place) {
    if (weight[place] > remaining) continue;
    chosen.push_back(static_cast<int>(place));
    for_each_multiset(weight, remaining - weight[place], place, chosen, sink);
    chosen.pop_back();
  }
}

double symmetry_of(const std::vector<RootedTree>& trees, const std::vector<int>& children) {
  double symmetry = 1.0;
  int multiplicity = 0;
  for (std::size_t i = 0; i < children.size(); ++i) {
    multiplicity = i > 0 && children[i] == children[i - 1] ? multiplicity + 1 : 1;
    symmetry *= multiplicity * trees[static_cast<std::size_t>(children[i])].symmetry;
  }
  return symmetry;
}

std::vector<RootedTree> make_rooted_trees(int highest_order) {
  std::vector<RootedTree> trees;
  for (int order = 1; order <= highest_order; ++order) {
    std::vector<int> weight;
    for (const RootedTree& tree : trees) weight.push_back(tree.order);
    std::vector<RootedTree> found;
    std::vector<int> chosen;
    for_each_multiset(weight, order - 1, 0, chosen, [&](const std::vector<int>& children) {
      RootedTree tree{.order = order, .children = children, .density = static_cast<double>(order)};
      for (int child : children) tree.density *= trees[static_cast<std::size_t>(child)].density;
      tree.symmetry = symmetry_of(trees, children);
      found.push_back(std::move(tree));
    });
    trees.insert(trees.end(), found.begin(), found.end());
  }
  return trees;
}

std::vector<NystromTree> make_nystrom_trees(int highest_order, bool velocity_forces) {
  std::vector<NystromTree> trees;
  for (int order = 1; order <= highest_order; ++order) {
    // Places: 0 is the velocity leaf, then each known tree through q, then each through v.
    const std::size_t known = trees.size();
    std::vector<int> weight = {1};
    for (const NystromTree& tree : trees) weight.push_back(tree.order + 1);
    if (velocity_forces) {
      for (const NystromTree& tree : trees) weight.push_back(tree.order);
    }
    std::vector<NystromTree> found;
    std::vector<int> chosen;
    for_each_multiset(weight, order - 1, 0, chosen, [&](const std::vector<int>& places) {
      NystromTree tree{.order = order, .exact = 1.0 / order};
      for (int place : places) {
        const auto p = static_cast<std::size_t>(place);
        if (p == 0) {
          ++tree.velocity_leaves;
        } else if (p <= known) {
          tree.through_position.push_back(place - 1);
          tree.exact *= trees[p - 1].exact / (trees[p - 1].order + 1);
        } else {
          tree.through_velocity.push_back(place - 1 - static_cast<int>(known));
          tree.exact *= trees[p - 1 - known].exact;
        }
      }
      found.push_back(std::move(tree));
    });
    trees.insert(trees.end(), found.begin(), found.end());
  }
  return trees;
}

std::vector<ColouredTree> make_coloured_trees(int highest_order) {
  std::vector<ColouredTree> trees;
  for (int order = 1; order <= highest_order; ++order) {
    std::vector<int> weight;
    for (const ColouredTree& tree : trees) weight.push_back(tree.order);
    std::vector<ColouredTree> found;
    std::vector<int> chosen;
    for_each_multiset(weight, order - 1, 0, chosen, [&](const std::vector<int>& children) {
      for (int colour = 0; colour < 2; ++colour) {
        ColouredTree tree{
            .order = order, .colour = colour, .children = children, .density = static_cast<double>(order)};
        for (int child : children) tree.density *= trees[static_cast<std::size_t>(child)].density;
        found.push_back(std::move(tree));
      }
    });
    trees.insert(trees.end(), found.begin(), found.end());
  }
  return trees;
}

}  // namespace

const std::vector<RootedTree>& rooted_trees(int highest_order) {
  static std::map<int, std::vector<RootedTree>> lists;
  static std::mutex mutex;
  return remembered(lists, mutex, highest_order, [&] { return make_rooted_trees(highest_order); });
}

const std::vector<NystromTree>& nystrom_trees(int highest_order, bool velocity_forces) {
  static std::map<std::pair<int, bool>, std::vector<NystromTree>> lists;
  static std::mutex mutex;
  return remembered(lists, mutex, std::pair(highest_order, velocity_forces),
                    [&] { return make_nystrom_trees(highest_order, velocity_forces); });
}

const std::vector<ColouredTree>& coloured_trees(int highest_order) {
  static std::map<int, std::vector<ColouredTree>> lists;
  static std::mutex mutex;
  return remembered(lists, mutex, highest_order, [&] { return make_coloured_trees(highest_order); });
}

}  // namespace fw::schemes
