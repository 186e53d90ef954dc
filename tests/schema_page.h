// Tables of numbers in schema pages and READMEs, which are made from the rows of the code.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace trephine::test {

// Expects `table` between the line "<!-- numbers: NAME; ... -->" and the next end of numbers. With
// TREPHINE_RENEW_PAGES in the environment it writes it there.
inline void expectNumbers(const std::filesystem::path& page, const std::string& name,
                          const std::string& table) {
  std::ostringstream read;
  read << std::ifstream(page).rdbuf();
  std::string text = read.str();
  const std::size_t mark = text.find("<!-- numbers: " + name + ";");
  ASSERT_NE(mark, std::string::npos) << page << " has no place for the numbers of '" << name << "'";
  const std::size_t begin = text.find('\n', mark) + 1;
  const std::size_t end = text.find("<!-- end of numbers -->", begin);
  ASSERT_NE(end, std::string::npos) << page;
  if (std::getenv("TREPHINE_RENEW_PAGES")) {
    std::ofstream(page) << text.replace(begin, end - begin, table);
    return;
  }
  EXPECT_EQ(text.substr(begin, end - begin), table)
      << page << " is not as the code has it: run this test with TREPHINE_RENEW_PAGES=1";
}

}  // namespace trephine::test
