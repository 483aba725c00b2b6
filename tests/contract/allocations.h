// How often this program has asked for memory: what steps must not do.
#ifndef PHRENIC_TESTS_CONTRACT_ALLOCATIONS_H_
#define PHRENIC_TESTS_CONTRACT_ALLOCATIONS_H_

#include <cstdint>

namespace phrenic {

// Calls of malloc so far, operator new's among them; always 0 under AddressSanitizer, which has a malloc of its own.
std::int64_t Allocations();

}  // namespace phrenic

#endif  // PHRENIC_TESTS_CONTRACT_ALLOCATIONS_H_
