// What the machine can do at most, measured where the rest is: a stream triad out of the last cache and out of memory,
// and multiply-adds that wait for nothing.
#ifndef PHRENIC_TESTS_BENCH_MACHINE_H_
#define PHRENIC_TESTS_BENCH_MACHINE_H_

#include <memory>
#include <vector>

#include "tests/bench/table.h"

namespace phrenic::bench {

// a = b + s c over three arrays (McCalpin 1995), `megabytes` together; 24 bytes a place.
Row Triad(const std::string& name, double megabytes);
// Products and sums in double precision by the machine's widest vectors.
Row MultiplyAdds(const std::string& name);

}  // namespace phrenic::bench

#endif  // PHRENIC_TESTS_BENCH_MACHINE_H_
