#include "components/swivel/report/report_page.hpp"

#include <fmt/core.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <sstream>

#include "calibration/units.hpp"
#include "components/common/program.hpp"

namespace swivel {
namespace {

constexpr const char* kStyle = R"(
body { font: 16px/1.5 "DejaVu Sans", Verdana, sans-serif; color: #111; background: #fff;
       max-width: 1200px; margin: 0 auto; padding: 1.5em; }
h1 { font-size: 1.6em; margin-bottom: 0.2em; } h2 { font-size: 1.2em; margin-top: 2.2em; }
table { border-collapse: collapse; margin: 0.6em 0; }
th, td { padding: 0.25em 0.9em; border-bottom: 1px solid #ccc; text-align: right; }
th { text-align: right; border-bottom: 2px solid #666; font-weight: 600; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
td.words, th.words { text-align: left; }
ul { list-style: none; padding-left: 0; } li { margin: 0.35em 0; padding-left: 7.5em; text-indent: -7.5em; }
li b { display: inline-block; width: 6em; text-indent: 0; padding: 0 0.4em; margin-right: 0.7em;
       border-left: 0.4em solid #6e6e6e; }
li.good b { border-color: #0072b2; } li.bad b { border-color: #d55e00; }
figure { margin: 0.5em 0; } figcaption { color: #333; max-width: 60em; margin: 0.3em 0; }
img { max-width: 100%; height: auto; border: 1px solid #ddd; }
.small { color: #555; font-size: 0.9em; }
)";

std::string cell(const std::string& text) {
  return "<td>" + escaped(text) + "</td>";
}

// A dash for what is not known.
std::string angle(double angle_rad) {
  return std::isnan(angle_rad) ? "-" : fmt::format("{:.3f}", deg_from_rad(angle_rad));
}

std::string signed_angle(double angle_rad) {
  return std::isnan(angle_rad) ? "-" : fmt::format("{:+.3f}", deg_from_rad(angle_rad));
}

std::string largest(const AngleStatistics& errors) {
  return angle(errors.count == 0 ? kUnknownAngle : errors.largest_rad());
}

std::string kept(const AngleStatistics& errors) {
  if (errors.count == 0) return "-";
  const double kept_m = kept_up_to_m(errors.largest_rad());
  return kept_m < kMapReach_m ? fmt::format("{:.2f}", kept_m) : "10 (all)";
}

std::string mode_row(const ModeEvaluation& mode) {
  std::string paper = "-";
  if (const auto paper_rad = papers_largest_rad(mode.mode))
    paper = fmt::format("{:.4f}; {:.2f} m", deg_from_rad(*paper_rad), kept_up_to_m(*paper_rad));
  return "<tr>" + cell(mode.mode == 0 ? "-" : std::to_string(mode.mode)) +
         cell(fmt::format("{} of {}", mode.with.count, mode.sweeps)) +
         cell(angle(mode.without.rms_rad)) + cell(largest(mode.without)) +
         cell(signed_angle(mode.with.mean_rad)) + cell(angle(mode.with.rms_rad)) +
         cell(largest(mode.with)) + cell(kept(mode.with)) + cell(paper) + "</tr>\n";
}

std::string mode_table(const Evaluation& evaluation) {
  std::string rows;
  for (const ModeEvaluation& mode : by_mode(evaluation.attitudes())) rows += mode_row(mode);
  return "<table>\n<tr><th>mode</th><th>corrected sweeps</th><th>without: rms, deg</th>"
         "<th>largest</th><th>with: mean, deg</th><th>rms</th><th>largest</th>"
         "<th>+-50 mm kept up to, m</th><th>Yuan 2021, largest</th></tr>\n" +
         rows + "</table>\n<p class=\"small\">phi_error against " +
         escaped(in_words(evaluation.reference)) +
         "; positive where the cloud lies clockwise of where it should, seen from above.</p>\n";
}

std::string sweep_row(const SweepFacts& sweep) {
  const SweepAttitude& attitude = sweep.attitude;
  const std::string seam =
      std::isnan(sweep.seam_deg)
          ? "-"
          : fmt::format("{:+.3f} +- {:.3f}", sweep.seam_deg, sweep.seam_sigma_deg);
  return "<tr>" + cell(std::to_string(attitude.sweep)) +
         cell(attitude.mode == 0 ? "-" : std::to_string(attitude.mode)) +
         cell(signed_angle(attitude.phi_offset_rad)) + cell(angle(attitude.sigma_rad)) +
         cell(signed_angle(attitude.without_rad)) + cell(signed_angle(attitude.with_rad)) +
         cell(seam) + "<td class=\"words\">" +
         escaped(sweep.verdict + (sweep.reason.empty() ? "" : ": " + sweep.reason)) +
         "</td></tr>\n";
}

std::string sweep_table(const Evaluation& evaluation) {
  std::string rows;
  for (const SweepFacts& sweep : evaluation.sweeps) rows += sweep_row(sweep);
  return "<table>\n<tr><th>sweep</th><th>mode</th><th>phi_offset, deg</th><th>sigma</th>"
         "<th>phi_error without</th><th>with</th><th>seam, deg</th>"
         "<th class=\"words\">verdict</th></tr>\n" +
         rows + "</table>\n";
}

std::string verdict_table(const Evaluation& evaluation) {
  std::string rows;
  for (const auto& [verdict, count] : evaluation.verdicts())
    rows += "<tr>" + cell(verdict) + cell(std::to_string(count)) + "</tr>\n";
  return "<table>\n<tr><th>verdict</th><th>sweeps</th></tr>\n" + rows + "</table>\n";
}

std::string finding_list(const Evaluation& evaluation) {
  std::string items;
  for (const Finding& finding : findings_of(evaluation)) {
    const bool good = finding.kind == Finding::Kind::kGood;
    const bool bad = finding.kind == Finding::Kind::kBad;
    items += fmt::format("<li class=\"{}\"><b>{}</b>{}</li>\n",
                         good  ? "good"
                         : bad ? "bad"
                               : "note",
                         good  ? "good"
                         : bad ? "not good"
                               : "note",
                         escaped(finding.words));
  }
  return "<ul>\n" + items + "</ul>\n";
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  if (!file) throw ExitError(kExitInputOutput, path + ": the picture cannot be read again");
  return bytes.str();
}

std::string picture_html(const Picture& picture, const std::string& heading) {
  const std::string label = escaped(picture.label.empty() ? heading : picture.label);
  return fmt::format("<img alt=\"{}\" src=\"data:image/png;base64,{}\">\n", label,
                     base64(bytes_of(picture.path))) +
         (picture.label.empty() ? "" : "<p class=\"small\">" + label + "</p>\n");
}

std::string figure_html(const Figure& figure, std::size_t number) {
  std::string html = fmt::format("<figure>\n<h2>{}. {}</h2>\n<figcaption>{}</figcaption>\n", number,
                                 escaped(figure.heading), escaped(figure.caption));
  for (const Picture& picture : figure.pictures) html += picture_html(picture, figure.heading);
  return html + "</figure>\n";
}

std::string fact_list(const PageHead& head) {
  std::string words;
  for (const auto& [name, value] : head.facts)
    words += (words.empty() ? "" : " &middot; ") + escaped(name) + ": " + escaped(value);
  return "<p class=\"small\">" + words + "</p>\n";
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char letter : text) {
    switch (letter) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default:
        safe += letter;
    }
  }
  return safe;
}

std::string base64(const std::string& bytes) {
  constexpr const char* kBase64Letters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t first = 0; first < bytes.size(); first += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - first);
    std::uint32_t bits = 0;
    for (std::size_t place = 0; place < 3; ++place) {
      const char byte = place < count ? bytes[first + place] : '\0';
      bits = bits << 8 | static_cast<unsigned char>(byte);
    }
    for (std::size_t place = 0; place < 4; ++place)
      text += place > count ? '=' : kBase64Letters[bits >> (18 - 6 * place) & 63U];
  }
  return text;
}

std::string report_page(const PageHead& head, const Evaluation& evaluation,
                        const std::vector<Figure>& figures) {
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" +
      escaped(head.title) + "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n<h1>" +
      escaped(head.title) + "</h1>\n" + fact_list(head);
  if (!evaluation.axis_measured) page += mode_table(evaluation);
  page += "<h2>What is good, what is not</h2>\n" + finding_list(evaluation);
  page += "<h2>Sweeps</h2>\n" + verdict_table(evaluation) + sweep_table(evaluation);
  std::size_t number = 0;
  for (const Figure& figure : figures)
    if (!figure.pictures.empty()) page += figure_html(figure, ++number);
  return page + "</body>\n</html>\n";
}

}  // namespace swivel
