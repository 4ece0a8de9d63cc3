#include "components/swivel/report/report_page.hpp"

#include <gmock/gmock.h>

#include <random>

#include "scratch_folder.hpp"

namespace swivel {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string decoded(const std::string& text) {
  std::string bytes;
  unsigned bits = 0;
  int held = 0;
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (const char letter : text) {
    if (letter == '=') break;
    bits = bits << 6 | static_cast<unsigned>(letters.find(letter));
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes += static_cast<char>(bits >> held & 0xFFU);
  }
  return bytes;
}

TEST(Base64, IsTheStandards) {  // RFC 4648, section 10
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

TEST(Base64, ComesBackAsItWentIn) {
  std::mt19937 random(1);
  std::string bytes;
  for (int length = 0; length < 70; ++length) {
    EXPECT_EQ(decoded(base64(bytes)), bytes);
    EXPECT_EQ(base64(bytes).size() % 4, 0U);
    bytes += static_cast<char>(random());
  }
}

SweepFacts sweep(std::size_t index, const std::string& verdict, const std::string& reason) {
  SweepFacts facts;
  facts.attitude.sweep = index;
  facts.attitude.mode = 1;
  facts.attitude.corrected = verdict == "good";
  if (facts.attitude.corrected) facts.attitude.phi_offset_rad = 0.1;
  judge_by_start(0.11, facts.attitude);
  facts.verdict = verdict;
  facts.reason = reason;
  return facts;
}

TEST(Page, HoldsItsPicturesAndNeedsNothingElse) {
  const ScratchFolder scratch;
  const std::string bytes("\x89PNG\0<>&\xFF", 9);
  std::ofstream(scratch.file("a.png"), std::ios::binary) << bytes;
  Evaluation evaluation;
  evaluation.reference = Reference::kTruth;
  evaluation.sweeps = {sweep(0, "good", "")};
  const std::string page = report_page(
      {"a title", {}}, evaluation, {{"heading", "caption", {{scratch.file("a.png"), "sweep 0"}}}});
  EXPECT_THAT(page, HasSubstr("src=\"data:image/png;base64," + base64(bytes) + "\""));
  for (const char* link : {"http:", "https:", "href", "url(", "<script", "<link", "file:"})
    EXPECT_THAT(page, Not(HasSubstr(link)));
  EXPECT_EQ(page.rfind("<!DOCTYPE html>", 0), 0U);
}

TEST(Page, TakesNoTextForMarkup) {
  const std::string evil = "<script>alert(\"1\" & '2')</script>";
  Evaluation evaluation;
  evaluation.sweeps = {sweep(0, "no_plate", evil)};
  evaluation.sweeps[0].warning = evil;
  evaluation.sweeps[0].worst_surface = evil;
  evaluation.sweeps[0].worst_share_within_40_mm = 0.1;
  const std::string page = report_page({evil, {{evil, evil}}}, evaluation, {{evil, evil, {}}});
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, Not(HasSubstr("alert(\"")));
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;alert(&quot;1&quot; &amp; &#39;2&#39;)"));
}

TEST(Page, APictureThatIsGoneIsSaid) {
  EXPECT_ANY_THROW(report_page({"", {}}, {}, {{"", "", {{"/nowhere/a.png", ""}}}}));
}

std::string words_of(const std::vector<Finding>& findings, Finding::Kind kind) {
  std::string words;
  for (const Finding& finding : findings)
    if (finding.kind == kind) words += finding.words + "\n";
  return words;
}

TEST(Findings, CountWhatHasNoAttitude) {
  Evaluation evaluation;
  evaluation.reference = Reference::kTruth;
  evaluation.sweeps = {sweep(0, "good", ""), sweep(1, "no_plate", "x"), sweep(2, "no_plate", "x"),
                       sweep(3, "foreign_object", "x")};
  const auto bad = words_of(findings_of(evaluation), Finding::Kind::kBad);
  EXPECT_THAT(bad, HasSubstr("3 of 4 sweeps have no attitude (1 foreign_object, 2 no_plate)"));
  EXPECT_EQ(by_mode(evaluation.attitudes())[0].with.count, 1U);
  EXPECT_EQ(by_mode(evaluation.attitudes())[0].without.count, 4U);
}

TEST(Findings, SayHowFarTheMapIsGood) {
  Evaluation evaluation;
  evaluation.reference = Reference::kTruth;
  evaluation.sweeps = {sweep(0, "good", "")};  // 0.01 rad off
  EXPECT_THAT(words_of(findings_of(evaluation), Finding::Kind::kBad), HasSubstr("5.00 m only"));
  evaluation.sweeps[0].attitude.with_rad = 0.001;
  EXPECT_THAT(words_of(findings_of(evaluation), Finding::Kind::kBad), Not(HasSubstr("only")));
  EXPECT_THAT(words_of(findings_of(evaluation), Finding::Kind::kGood), HasSubstr("up to 10 m"));
}

TEST(Findings, TellAnOpenSeamFromAClosedAndFromAnUnknownOne) {
  Evaluation evaluation;
  evaluation.sweeps = {sweep(0, "good", "")};
  EXPECT_THAT(words_of(findings_of(evaluation), Finding::Kind::kNote), HasSubstr("seam_deg"));
  evaluation.sweeps[0].seam_deg = -1.8;
  evaluation.sweeps[0].seam_sigma_deg = 0.05;
  EXPECT_THAT(words_of(findings_of(evaluation), Finding::Kind::kBad), HasSubstr("seam is open"));
  evaluation.sweeps[0].seam_deg = -0.05;
  EXPECT_THAT(words_of(findings_of(evaluation), Finding::Kind::kGood), HasSubstr("closed in 1 of"));
}

TEST(Findings, AnErrorThatAllShareIsAlphas) {
  Evaluation evaluation;
  evaluation.reference = Reference::kTruth;
  for (std::size_t index = 0; index < 6; ++index) {
    evaluation.sweeps.push_back(sweep(index, "good", ""));
    evaluation.sweeps.back().attitude.with_rad = 0.005 + (index % 2 == 0 ? 1e-4 : -1e-4);
  }
  const auto bad = words_of(findings_of(evaluation), Finding::Kind::kBad);
  EXPECT_THAT(bad, HasSubstr("share an error of +0.286 deg"));
  EXPECT_THAT(bad, HasSubstr("calibrate alpha"));
  for (SweepFacts& facts : evaluation.sweeps) facts.attitude.with_rad -= 0.005;
  EXPECT_THAT(words_of(findings_of(evaluation), Finding::Kind::kBad), Not(HasSubstr("share")));
}

}  // namespace
}  // namespace swivel
