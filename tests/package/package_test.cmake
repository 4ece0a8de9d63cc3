# Installs what is built, builds another program against it with find_package(swivel), runs it,
# and runs the installed swivel, which must find its own configuration.
#   cmake -DBUILD_DIR=... -DSOURCE_DIR=... -DSCRATCH=... -P package_test.cmake
function(must)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nended with ${code}:\n${out}")
  endif()
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
must(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${SCRATCH}/prefix)
must(${CMAKE_COMMAND} -S ${SOURCE_DIR}/consumer -B ${SCRATCH}/build -G Ninja
     -DCMAKE_PREFIX_PATH=${SCRATCH}/prefix)
must(${CMAKE_COMMAND} --build ${SCRATCH}/build)
must(${SCRATCH}/build/consumer)

must(${SCRATCH}/prefix/bin/swivel --version)
foreach(file rigs/yuan.yaml dds_profiles.xml benches/yuan.yaml idl/swivel.idl idl/point_cloud2.idl)
  if(NOT EXISTS ${SCRATCH}/prefix/share/swivel/${file})
    message(FATAL_ERROR "share/swivel/${file} was not installed")
  endif()
endforeach()
# 69: the configuration was found, and nobody of the rig is there.
execute_process(COMMAND ${SCRATCH}/prefix/bin/swivel status --watch-s 0.5 --domain 231
                RESULT_VARIABLE code OUTPUT_QUIET ERROR_VARIABLE said)
if(NOT code EQUAL 69)
  message(FATAL_ERROR "the installed swivel status ended with ${code}: ${said}")
endif()
