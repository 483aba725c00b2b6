// Bucket sort for items with a small dense integer key, such as a vertex index. O(n + keys) plus the sort within
// buckets.
#ifndef PHRENIC_SERVER_MESH_BUCKET_SORT_H_
#define PHRENIC_SERVER_MESH_BUCKET_SORT_H_

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace phrenic {

// Sorts `items` ascending, with the same result as std::sort. `key(item)` returns a value in [0, keys) and must be the
// most significant part of operator<. Each bucket is sorted by comparison, so buckets should be small.
template <typename Item, typename Key>
void BucketSort(std::vector<Item>& items, int keys, const Key& key) {
  std::vector<std::int64_t> first(static_cast<size_t>(keys) + 1, 0);
  for (const Item& item : items) ++first[key(item) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<Item> sorted(items.size());
  std::vector<std::int64_t> next(first.begin(), first.end() - 1);
  for (const Item& item : items) sorted[next[key(item)]++] = item;
  for (int k = 0; k < keys; ++k) std::sort(sorted.begin() + first[k], sorted.begin() + first[k + 1]);
  items.swap(sorted);
}

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_BUCKET_SORT_H_
