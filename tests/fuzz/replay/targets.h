// The fuzz targets of one build, by name.
#ifndef PHRENIC_TESTS_FUZZ_REPLAY_TARGETS_H_
#define PHRENIC_TESTS_FUZZ_REPLAY_TARGETS_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace phrenic::fuzz {

using Target = int (*)(const std::uint8_t* data, std::size_t size);  // LLVMFuzzerTestOneInput of a file

const std::map<std::string, Target>& Targets();

}  // namespace phrenic::fuzz

#endif  // PHRENIC_TESTS_FUZZ_REPLAY_TARGETS_H_
