# The house of docs and design: three leaves that do not know each other, components above them.
# Run as: cmake -D ROOT=<the repository> -P layering.cmake
cmake_minimum_required(VERSION 3.22)

set(ours "^(idl|swivel|hardware|calibration|components|tests)/")
set(dds "^(fastdds|fastrtps|fastcdr|swivel/idl)/")
set(violations "")

# No source below FOLDER may include what matches one of the patterns.
function(forbid folder reason)
  file(GLOB_RECURSE sources "${ROOT}/${folder}/*.hpp" "${ROOT}/${folder}/*.h" "${ROOT}/${folder}/*.cpp"
    "${ROOT}/${folder}/*.idl")
  if(NOT sources)
    message(FATAL_ERROR "no sources below ${ROOT}/${folder}: is ROOT right?")
  endif()
  foreach(source IN LISTS sources)
    file(STRINGS "${source}" includes REGEX "^[ \t]*#[ \t]*include[ \t]*[<\"]")
    foreach(line IN LISTS includes)
      string(REGEX REPLACE "^[ \t]*#[ \t]*include[ \t]*[<\"]([^>\"]*)[>\"].*" "\\1" header "${line}")
      foreach(pattern IN LISTS ARGN)
        if(header MATCHES "${pattern}")
          list(APPEND violations "${source} includes ${header}: ${reason}")
        endif()
      endforeach()
    endforeach()
  endforeach()
  set(violations "${violations}" PARENT_SCOPE)
endfunction()

forbid(hardware "hardware is POSIX only, a leaf"
  "^(idl|calibration|components|tests)/" "${dds}" "^(Eigen|unsupported/Eigen|ceres|pcl)/")
forbid(hardware/sim "the simulator's geometry is written apart" "calibration/")
forbid(calibration "calibration is a leaf, without middleware"
  "^(idl|hardware|components|tests)/" "${dds}")
forbid(idl "idl is a leaf" "${ours}")
forbid(components "what ships does not need its tests" "^tests/")

# A header included by a path of its own folder would hide its leaf from the rules above.
foreach(folder hardware calibration components idl)
  forbid(${folder} "include from the root of the tree" "\\.\\./")
endforeach()

find_program(GIT git)
if(GIT AND EXISTS "${ROOT}/.git")
  execute_process(COMMAND ${GIT} -C ${ROOT} ls-files OUTPUT_VARIABLE tracked ERROR_QUIET
    RESULT_VARIABLE git_failed)
  string(REGEX MATCHALL "[^\n]*(PubSubTypes|TypeObject|CdrAux|generated/)[^\n]*|idl/[^\n]*\\.(h|cxx|ipp)\n"
    generated "${tracked}")
  foreach(file IN LISTS generated)
    list(APPEND violations "${file} is tracked: generated code is never committed")
  endforeach()
endif()

if(violations)
  list(JOIN violations "\n  " text)
  message(FATAL_ERROR "the layering is broken:\n  ${text}")
endif()
