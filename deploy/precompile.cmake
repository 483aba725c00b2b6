# Precompiled headers of sanitizer builds by clang: the headers of the libraries take a quarter of the time in which it
# compiles a unit. Other builds read each header where it is included, so that a missing #include is an error there.
# clang takes a precompiled header only at the level of optimisation at which it was made, so there is one for each.
file(WRITE ${PROJECT_BINARY_DIR}/generated/precompiled.cc "")
foreach(level O0 O1)
  add_library(phrenic_headers_${level} OBJECT ${PROJECT_BINARY_DIR}/generated/precompiled.cc)
  target_link_libraries(phrenic_headers_${level} PRIVATE phrenic_options phrenic_grpc Eigen3::Eigen GTest::gmock)
  target_compile_options(phrenic_headers_${level} PRIVATE -${level} "SHELL:-Xclang -fno-pch-timestamp")
  target_precompile_headers(phrenic_headers_${level} PRIVATE
    <gmock/gmock.h> <gtest/gtest.h> <Eigen/Dense> <Eigen/Sparse> <grpcpp/grpcpp.h>
    <absl/container/flat_hash_map.h> <absl/status/statusor.h> <absl/strings/str_cat.h> <absl/strings/str_join.h>
    <absl/strings/str_split.h> <absl/synchronization/mutex.h> <absl/time/time.h>
    <algorithm> <chrono> <filesystem> <fstream> <functional> <iostream> <map> <memory> <numeric> <optional> <random> <set>
    <sstream> <string> <thread> <variant> <vector>
    <phrenic/v1/answers.pb.h> <phrenic/v1/scene.pb.h> <phrenic/v1/session.grpc.pb.h> <phrenic/v1/study.grpc.pb.h>)
  add_dependencies(phrenic_headers_${level} generated_headers)
endforeach()

foreach(folder server client tests)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  list(REMOVE_ITEM targets phrenic_tsan)  # wraps functions of Abseil
  foreach(target ${targets})
    get_target_property(type ${target} TYPE)
    if(type MATCHES "STATIC_LIBRARY|EXECUTABLE")
      get_target_property(options ${target} COMPILE_OPTIONS)
      target_compile_options(${target} PRIVATE -pthread)  # which gRPC asks for, and so the headers have
      if("-O1" IN_LIST options)
        target_precompile_headers(${target} REUSE_FROM phrenic_headers_O1)
      else()
        target_precompile_headers(${target} REUSE_FROM phrenic_headers_O0)
      endif()
    endif()
  endforeach()
endforeach()
