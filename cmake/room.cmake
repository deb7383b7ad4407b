# fts_room(NAME SOURCES... PUBLIC libs... PRIVATE libs...): a static library for one room of the house.
function(fts_room name)
    cmake_parse_arguments(ROOM "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
    add_library(${name} STATIC ${ROOM_SOURCES})
    target_link_libraries(${name} PUBLIC fts_flags ${ROOM_PUBLIC} PRIVATE ${ROOM_PRIVATE})
    if(FTS_PRECOMPILE)
        target_precompile_headers(${name} REUSE_FROM fts_precompiled)
    endif()
endfunction()

# fts_program(NAME SOURCES... LIBS...): an executable under build/<preset>/bin.
function(fts_program name)
    cmake_parse_arguments(PROGRAM "" "" "SOURCES;LIBS" ${ARGN})
    add_executable(${name} ${PROGRAM_SOURCES})
    target_link_libraries(${name} PRIVATE fts_flags ${PROGRAM_LIBS})
endfunction()
