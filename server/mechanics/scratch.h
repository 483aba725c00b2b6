// Memory for intermediate results that is kept from one call to the next, so that no step allocates.
#ifndef PHRENIC_SERVER_MECHANICS_SCRATCH_H_
#define PHRENIC_SERVER_MECHANICS_SCRATCH_H_

#include <memory>
#include <typeindex>
#include <typeinfo>
#include <utility>
#include <vector>

namespace phrenic {

// Holds one object of each type that was asked for. Each user has a type of its own (`struct AreaVectors { Points a;
// }`) and resizes it to fit. Nothing that a result depends on outlives a call: a fresh Scratch gives the same bits.
// Serves one model, which outlives its use: what is computed again only after a change is known by the address of its
// element. Copies refer to the same memory. One thread at a time; blocks of a step (ForEachBlock) do not use it.
class Scratch {
 public:
  Scratch() : slots_(std::make_shared<std::vector<Slot>>()) {}

  // Returns the T. The first call makes it from `arguments` and allocates. The reference stays valid as long as any
  // copy of this Scratch.
  template <typename T, typename... Arguments>
  T& Get(Arguments&&... arguments) const {
    for (const Slot& slot : *slots_) {
      if (slot.type == typeid(T)) return *static_cast<T*>(slot.object.get());
    }
    slots_->push_back({typeid(T), std::make_shared<T>(std::forward<Arguments>(arguments)...)});
    return *static_cast<T*>(slots_->back().object.get());
  }

 private:
  struct Slot {
    std::type_index type;
    std::shared_ptr<void> object;
  };
  std::shared_ptr<std::vector<Slot>> slots_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SCRATCH_H_
