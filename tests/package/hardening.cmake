# What the compiler, the linker and systemd were asked for to make a flaw hard to use, read back
# from the programs and the units of the package.
function(must_be_hardened program)
  must(readelf --wide --file-header --program-headers --dynamic --dyn-syms ${program})
  must_match("${out}" "Type: +DYN \\(Position-Independent Executable" "${program}, any address")
  must_match("${out}" " GNU_RELRO " "${program}, tables read-only")
  must_match("${out}" "\\(FLAGS(_1)?\\)[^\n]*NOW" "${program}, tables filled at the start")
  must_match("${out}" " GNU_STACK +0x0+ 0x0+ 0x0+ 0x0+ 0x0+ RW " "${program}, stack not executable")
  must_match("${out}" "__stack_chk_fail@" "${program}, stack protector")
  # The guard is too small to have a copy that needs a check.
  if(NOT program MATCHES "/motor_guard$")
    must_match("${out}" "__[a-z]+_chk@" "${program}, checked copies")
  endif()
endfunction()

function(must_be_confined unit)
  file(READ ${unit} text)
  foreach(line User=swivel NoNewPrivileges=yes ProtectSystem=strict ProtectHome=yes
          CapabilityBoundingSet= RestrictSUIDSGID=yes "SystemCallFilter=@system-service")
    must_match("${text}" "\n${line}\n" "${unit}")
  endforeach()
  # Killed together with the sequencer, the guard could not stop the motor.
  if(unit MATCHES "stepper-sequencer")
    must_match("${text}" "\nKillMode=process\n" "${unit}")
  else()
    must_match("${text}" "\nKillMode=control-group\n" "${unit}")
  endif()
endfunction()
