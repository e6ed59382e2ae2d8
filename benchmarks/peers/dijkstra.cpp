// Dijkstra from point to point on a graph in compressed rows, with a binary heap: what a compiled planner costs.
#include <cstdint>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

// Returns the length of the shortest path, -1 where there is none. `first` has nodes + 1 numbers.
extern "C" int64_t shortest(int32_t nodes, const int32_t *first, const int32_t *target, const int32_t *weight,
                            int32_t start, int32_t goal) {
  static std::vector<int64_t> distance;
  static std::vector<uint32_t> seen;  // the search in which a node was last reached: nothing is cleared in between
  static uint32_t search = 0;
  if (seen.size() != static_cast<std::size_t>(nodes)) {
    distance.assign(nodes, 0);
    seen.assign(nodes, 0);
    search = 0;
  }
  ++search;
  using Entry = std::pair<int64_t, int32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
  distance[start] = 0;
  seen[start] = search;
  queue.push({0, start});
  while (!queue.empty()) {
    const auto [here, node] = queue.top();
    queue.pop();
    if (node == goal) return here;
    if (here > distance[node]) continue;
    for (int32_t edge = first[node]; edge < first[node + 1]; ++edge) {
      const int32_t next = target[edge];
      const int64_t there = here + weight[edge];
      if (seen[next] != search || there < distance[next]) {
        seen[next] = search;
        distance[next] = there;
        queue.push({there, next});
      }
    }
  }
  return -1;
}
