# Language level, warnings and sanitizers for every target of this tree (not for dependencies).
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

add_library(saras_compiler_options INTERFACE)
target_compile_options(saras_compiler_options INTERFACE -Wall -Wextra)
if(SARAS_WARNINGS_AS_ERRORS)
  target_compile_options(saras_compiler_options INTERFACE -Werror)
endif()
if(SARAS_SANITIZE)
  # Without following every variable: with sanitizers gcc takes minutes for that in the files with large laws.
  target_compile_options(saras_compiler_options INTERFACE -fsanitize=${SARAS_SANITIZE} -fno-omit-frame-pointer -g
    $<$<CXX_COMPILER_ID:GNU>:-fno-var-tracking-assignments>)
  target_link_options(saras_compiler_options INTERFACE -fsanitize=${SARAS_SANITIZE})
endif()
