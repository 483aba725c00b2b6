// Viewers over gRPC-web, as browsers are: a connection for the stream and one for acknowledgements, HTTP/1.1.
#ifndef PHRENIC_TESTS_BENCH_STREAMING_GATEWAY_VIEWERS_H_
#define PHRENIC_TESTS_BENCH_STREAMING_GATEWAY_VIEWERS_H_

#include "tests/bench/streaming/viewers.h"

namespace phrenic::bench {

// `web_port` on this machine; one thread serves them all.
std::unique_ptr<Viewers> WatchOverGateway(int web_port, const Wanted& wanted);

}  // namespace phrenic::bench

#endif  // PHRENIC_TESTS_BENCH_STREAMING_GATEWAY_VIEWERS_H_
