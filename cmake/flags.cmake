# Flags that every target of the project is built with. Third-party headers come in as SYSTEM, so the
# strict set speaks of our code only.

add_library(fts_flags INTERFACE)

# The golden state hash must be the same on every compiler and optimisation level: no fused
# multiply-add, no reassociation.
target_compile_options(fts_flags INTERFACE -ffp-contract=off -fno-fast-math)

target_compile_options(
    fts_flags
    INTERFACE -Wall
              -Wextra
              -Wpedantic
              -Wconversion
              -Wsign-conversion
              -Wshadow
              -Wold-style-cast
              -Wnon-virtual-dtor
              -Woverloaded-virtual
              -Wdouble-promotion
              -Wimplicit-fallthrough
              -Wundef
              -Werror)

# gcc 12 sees overflows inside std::string that are not there (GCC bugs 105329, 105651); real ones are the
# address sanitizer's to find.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(fts_flags INTERFACE -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow
                                               -Wno-stringop-overread)
endif()

# SDL's own flags define it; where it is the same for all, all can share precompiled headers.
target_compile_definitions(fts_flags INTERFACE _REENTRANT)

# Names the root so that every include is written from it.
target_include_directories(fts_flags INTERFACE ${PROJECT_SOURCE_DIR})

set(FTS_SANITIZE "" CACHE STRING "Sanitizers to build with: 'address,undefined', 'thread' or empty")
if(FTS_SANITIZE)
    target_compile_options(fts_flags INTERFACE -fsanitize=${FTS_SANITIZE} -fno-sanitize-recover=all
                                               -fno-omit-frame-pointer)
    target_link_options(fts_flags INTERFACE -fsanitize=${FTS_SANITIZE})
endif()

option(FTS_FUZZ "Build the libFuzzer targets (clang only)" OFF)
if(FTS_FUZZ)
    target_compile_options(fts_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()
