// Memory for large arrays in huge pages (Linux: madvise(2), MADV_HUGEPAGE), aligned to such a page. The first access to
// 10 MB of new memory in pages of 4 KiB took 3 ms on one machine, and 25 ms on a nested virtual machine.
#ifndef PHRENIC_SERVER_MECHANICS_LINALG_LARGE_PAGES_H_
#define PHRENIC_SERVER_MECHANICS_LINALG_LARGE_PAGES_H_

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace phrenic {

// An allocator for std::vector. Elements that `resize` appends are not initialised, so that memory is first accessed
// when it is first written. Thread-safe. Throws std::bad_alloc if there is no memory.
template <typename T>
class LargePages {
 public:
  using value_type = T;
  LargePages() = default;
  template <typename U>
  explicit LargePages(const LargePages<U>&) {}

  T* allocate(size_t count) {
    const size_t bytes = count * sizeof(T);
    if (bytes < kLeast) return std::allocator<T>().allocate(count);
    void* const memory = std::aligned_alloc(kPage, Whole(bytes));
    if (memory == nullptr) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
    madvise(memory, Whole(bytes), MADV_HUGEPAGE);  // a hint: small pages work too
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, size_t count) {
    const size_t bytes = count * sizeof(T);
    if (bytes < kLeast) return std::allocator<T>().deallocate(memory, count);
    std::free(memory);
  }
  template <typename U>
  void construct(U* place) {
    ::new (place) U;
  }
  template <typename U, typename... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (place) U(std::forward<Arguments>(arguments)...);
  }
  bool operator==(const LargePages&) const { return true; }

 private:
  static constexpr size_t kPage = size_t{1} << 21, kLeast = kPage;  // bytes
  static constexpr size_t Whole(size_t bytes) { return (bytes + kPage - 1) / kPage * kPage; }
};

template <typename T>
using LargeVector = std::vector<T, LargePages<T>>;

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_LINALG_LARGE_PAGES_H_
