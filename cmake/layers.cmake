# One target a folder. A folder sees the headers of the folders it links, and no others: each target's include
# directory holds a single link to its own folder, so that an include against the order of the layers does not compile.

# The flags that every target of ours is built with: warnings, sanitizers, and arithmetic that is the same everywhere.
add_library(skybake_flags INTERFACE)
target_compile_options(skybake_flags INTERFACE
  -Wall -Wextra -Wconversion -Wshadow -Wno-sign-conversion
  -ffp-contract=off # same sums on every instruction set (docs/decisions/0004)
  $<$<BOOL:${SKYBAKE_WERROR}>:-Werror>)
if(SKYBAKE_SANITIZE)
  target_compile_options(skybake_flags INTERFACE -fsanitize=${SKYBAKE_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(skybake_flags INTERFACE -fsanitize=${SKYBAKE_SANITIZE})
endif()

# skybake_layer(name LINK libs... [PRIVATE_LINK libs...]): the folder src/<name> as target skybake_<name>, every .cpp below it.
function(skybake_layer name)
  cmake_parse_arguments(ARG "" "" "LINK;PRIVATE_LINK" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
  set(view ${PROJECT_BINARY_DIR}/layers/${name})
  file(MAKE_DIRECTORY ${view})
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR}/${name} ${view}/${name} SYMBOLIC)
  if(sources)
    add_library(skybake_${name} STATIC ${sources})
    target_include_directories(skybake_${name} PUBLIC ${view})
    target_link_libraries(skybake_${name} PUBLIC ${ARG_LINK} PRIVATE skybake_flags ${ARG_PRIVATE_LINK})
  else()
    add_library(skybake_${name} INTERFACE)
    target_include_directories(skybake_${name} INTERFACE ${view})
    target_link_libraries(skybake_${name} INTERFACE ${ARG_LINK})
  endif()
endfunction()
