# The page as a constant of a header, so that the program needs no files beside it.
# Run as: cmake -D PAGE_DIR=... -D HEADER=... -P embed_page.cmake
# In page.html a line /* name */ stands for the content of the file of that name.
cmake_minimum_required(VERSION 3.22)

file(READ "${PAGE_DIR}/page.html" page)
foreach(part page.css cloud_canvas.js plate_canvas.js panel.js page.js)
  file(READ "${PAGE_DIR}/${part}" content)
  string(REPLACE "/* ${part} */" "${content}" page "${page}")
endforeach()

file(WRITE "${HEADER}" "#pragma once
#include <string_view>
namespace swivel {
inline constexpr std::string_view kPage = R\"embedded(${page})embedded\";
}
")
