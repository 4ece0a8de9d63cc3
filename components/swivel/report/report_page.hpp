// A page of HTML with its pictures inside: one file, readable without a network.
#pragma once

#include <string>
#include <vector>

#include "components/swivel/report/findings.hpp"

namespace swivel {

// & < > " and ' as entities.
std::string escaped(const std::string& text);

std::string base64(const std::string& bytes);

struct Picture {
  std::string path;   // of the PNG
  std::string label;  // which sweep; empty where it is of all
};

struct Figure {
  std::string heading;
  std::string caption;  // what one sees
  std::vector<Picture> pictures;
};

struct PageHead {
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;  // name, value
};

// Throws ExitError where a picture cannot be read.
std::string report_page(const PageHead& head, const Evaluation& evaluation,
                        const std::vector<Figure>& figures);

}  // namespace swivel
