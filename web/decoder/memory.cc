// Memory of the decoder in WebAssembly: the page writes bytes there and reads positions. Where memory is short the
// module traps, so that nothing is written through null; the page then makes another instance.
#include <cstdlib>
#include <new>

namespace {

void* AllocateOrTrap(std::size_t size) {
  void* const memory = std::malloc(size);
  if (memory == nullptr) __builtin_trap();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) { return AllocateOrTrap(size); }
void* operator new[](std::size_t size) { return AllocateOrTrap(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

extern "C" {

// Returns memory aligned to 16 bytes; phrenic_release frees it.
__attribute__((visibility("default"), used)) void* phrenic_allocate(std::size_t size) { return AllocateOrTrap(size); }
__attribute__((visibility("default"), used)) void phrenic_release(void* memory) { std::free(memory); }
}
