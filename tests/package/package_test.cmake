# Makes the Debian packages of what is built, unpacks them into a folder, and looks at them there as
# a user's system would: programs are hardened, start and find their libraries and configuration, systemd
# takes the units, and the examples build against the packages alone.
#   cmake -DBUILD_DIR=... -DEXAMPLES=... -DSCRATCH=... -P package_test.cmake
function(must)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nended with ${code}:\n${out}")
  endif()
  set(out "${out}" PARENT_SCOPE)
endfunction()

function(must_match text pattern what)
  if(NOT text MATCHES "${pattern}")
    message(FATAL_ERROR "${what}: no '${pattern}' in\n${text}")
  endif()
endfunction()

include(${CMAKE_CURRENT_LIST_DIR}/hardening.cmake)

file(REMOVE_RECURSE ${SCRATCH})
set(root ${SCRATCH}/root)
must(cpack --config ${BUILD_DIR}/CPackConfig.cmake -B ${SCRATCH}/packages)
file(GLOB packages ${SCRATCH}/packages/*.deb)
list(LENGTH packages count)
if(NOT count EQUAL 2)
  message(FATAL_ERROR "not two packages but: ${packages}")
endif()
foreach(package IN LISTS packages)
  must(dpkg-deb -x ${package} ${root})
  must(dpkg-deb -f ${package} Depends)
  if(package MATCHES "swivel-dev_")
    must_match("${out}" "swivel \\(= [0-9.]+\\), .*libfastrtps-dev" "swivel-dev depends on")
  else()
    must_match("${out}" "libfastrtps2.*libpcl-" "swivel depends on")
  endif()
endforeach()

file(GLOB programs ${root}/usr/bin/*)
foreach(program IN LISTS programs)
  must_be_hardened(${program})
endforeach()
list(FILTER programs EXCLUDE REGEX "/motor_guard$")  # the sequencer's own
foreach(program IN LISTS programs)
  must(${program} --version)
  must_match("${out}" "^[a-z_-]+( view)? [0-9]+\\.[0-9]+\\.[0-9]+" "${program} --version")
endforeach()
# 69: the configuration was found, and nobody of the rig is there.
execute_process(COMMAND ${root}/usr/bin/swivel status --watch-s 0.5 --domain 231
                RESULT_VARIABLE code OUTPUT_QUIET ERROR_VARIABLE said)
if(NOT code EQUAL 69)
  message(FATAL_ERROR "the installed swivel status ended with ${code}: ${said}")
endif()

# systemd takes every word of the units, and the programs that they start are there.
file(GLOB units RELATIVE ${root}/usr/lib/systemd/system ${root}/usr/lib/systemd/system/*)
list(LENGTH units count)
if(NOT count EQUAL 8)
  message(FATAL_ERROR "not six participants and two roles but: ${units}")
endif()
must(systemd-analyze verify --root=${root} --man=no --recursive-errors=no ${units})
list(FILTER units INCLUDE REGEX "\\.service$")
foreach(unit IN LISTS units)
  must_be_confined(${root}/usr/lib/systemd/system/${unit})
endforeach()

file(MAKE_DIRECTORY ${root}/etc)
must(systemd-sysusers --root=${root} ${root}/usr/lib/sysusers.d/swivel.conf)
file(READ ${root}/etc/passwd users)
must_match("${users}" "swivel:x:[0-9]+:[0-9]+:[^\n]*:/var/lib/swivel:" "the user swivel")
foreach(file lib/udev/rules.d/60-swivel.rules lib/sysctl.d/60-swivel.conf
        share/swivel/rigs/yuan.yaml share/swivel/benches/yuan.yaml)
  if(NOT EXISTS ${root}/usr/${file})
    message(FATAL_ERROR "${file} is not in the package")
  endif()
endforeach()

must(${CMAKE_COMMAND} -S ${EXAMPLES}/fast_dds_subscriber -B ${SCRATCH}/fast_dds_subscriber -G Ninja
     -DCMAKE_PREFIX_PATH=${root}/usr)
must(${CMAKE_COMMAND} -S ${EXAMPLES}/cyclone_dds_subscriber -B ${SCRATCH}/cyclone_dds_subscriber
     -G Ninja -DSWIVEL_IDL=${root}/usr/share/swivel/idl)
must(${CMAKE_COMMAND} --build ${SCRATCH}/fast_dds_subscriber)
must(${CMAKE_COMMAND} --build ${SCRATCH}/cyclone_dds_subscriber)
