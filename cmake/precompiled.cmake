# Reading Eigen, GoogleTest and the standard library is most of what compiling a source takes. With
# FTS_PRECOMPILE it is done once, for rooms and for tests. The release preset and what clang-tidy reads go without,
# so that a source of the programs that forgets an include is still found out.
option(FTS_PRECOMPILE "Read the common third-party headers once for all sources" OFF)
if(NOT FTS_PRECOMPILE)
    return()
endif()

set(FTS_COMMON_HEADERS
    <Eigen/Core>
    <algorithm>
    <array>
    <cmath>
    <cstdint>
    <functional>
    <map>
    <memory>
    <optional>
    <span>
    <string>
    <string_view>
    <variant>
    <vector>)
file(WRITE ${CMAKE_BINARY_DIR}/precompiled/nothing.cpp "")

add_library(fts_precompiled OBJECT ${CMAKE_BINARY_DIR}/precompiled/nothing.cpp)
target_link_libraries(fts_precompiled PRIVATE fts_flags Eigen3::Eigen)
target_precompile_headers(fts_precompiled PRIVATE ${FTS_COMMON_HEADERS})

if(BUILD_TESTING)
    find_package(GTest REQUIRED)
    add_library(fts_precompiled_for_tests OBJECT ${CMAKE_BINARY_DIR}/precompiled/nothing.cpp)
    target_link_libraries(fts_precompiled_for_tests PRIVATE fts_flags Eigen3::Eigen GTest::gmock GTest::gtest)
    target_precompile_headers(fts_precompiled_for_tests PRIVATE ${FTS_COMMON_HEADERS} <gmock/gmock.h>
                              <gtest/gtest.h>)
endif()
