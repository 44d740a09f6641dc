#include "io/quantity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <clocale>

namespace eigengrain::io {
namespace {

using testing::HasSubstr;

struct Written {
  const char* text;
  const char* unit;
  double si;
};

TEST(Quantity, ReadsUnitsIntoSI) {
  for (const auto& [text, unit, si] : std::initializer_list<Written>{
           {"5 mm", "m", 0.005},
           {"5mm", "m", 0.005},
           {"  5\tmm ", "m", 0.005},
           {"3 µm", "m", 3e-6},
           {"3 um", "m", 3e-6},
           {"2 nm", "m", 2e-9},
           {"12 cm", "m", 0.12},
           {"1 dm", "m", 0.1},
           {"-1.5 km", "m", -1500},
           {"48 GPa", "Pa", 48e9},
           {"2.5 g/cm3", "kg/m3", 2500},
           {"2.5 t/m³", "kg/m3", 2500},
           {"2500 kg*m^-3", "kg/m3", 2500},
           {"2500 kg·m⁻³", "kg/m3", 2500},
           {"1e5 N/m", "N/m", 1e5},
           {"1e5 kg/s2", "N/m", 1e5},
           {"100 N/mm", "N/m", 1e5},
           {"0.5 kN / mm", "N/m", 5e5},
           {"9.81 m/s2", "m/s2", 9.81},
           {"9.81 m s-2", "m/s2", 9.81},
           {"9.81 m/s^2", "m/s2", 9.81},
           {"9.81 m/s/s", "m/s2", 9.81},
           {"10 us", "s", 1e-5},
           {"2 min", "s", 120},
           {"1.5 h", "s", 5400},
           {"3 ms", "s", 0.003},
           {"50 1/s", "1/s", 50},
           {"50 /s", "1/s", 50},
           {"250 mg", "kg", 2.5e-4},
           {"3 Mg", "kg", 3000},
           {"3 t", "kg", 3000},
           {"0.5", "", 0.5},
           {"+0.5", "", 0.5},
           {".5", "m", 0.5},
           {"5.", "m", 5},
           {"1e-5", "s", 1e-5},
           {"-0", "m", 0},
       }) {
    const Parsed<double> result = read_quantity(text, unit);
    ASSERT_TRUE(result.value.has_value()) << text << ": " << result.problem;
    EXPECT_DOUBLE_EQ(*result.value, si) << text;
    EXPECT_EQ(result.problem, "");
  }
}

TEST(Quantity, DecimalPrefixesAreExactlyRounded) {
  EXPECT_EQ(read_quantity("5 mm", "m").value, 0.005);
  EXPECT_EQ(read_quantity("9.3 mm", "m").value, 0.0093);
  EXPECT_EQ(read_quantity("2.5 g/cm3", "kg/m3").value, 2500.0);
}

struct Wrong {
  const char* text;
  const char* unit;
  const char* problem;
};

TEST(Quantity, SaysWhatIsWrongAndWhatToWrite) {
  for (const auto& [text, unit, problem] : std::initializer_list<Wrong>{
           {"2500 kg", "kg/m3", R"("2500 kg" is a mass; a density is wanted, e.g. "2500 kg/m3")"},
           {"9.81 m", "m/s2", R"("9.81 m" is a length; an acceleration is wanted, e.g. "9.81 m/s2")"},
           {"0.5 N", "", R"("0.5 N" is a force; a pure number is wanted, e.g. "0.5")"},
           {"10 turns", "", R"("10 turns": "turns" is no unit known here)"},
           {"5 /s", "s", R"("5 /s" is a rate; a time is wanted, e.g. "5 s")"},
           {"5 m2 kg s", "m", R"("5 m2 kg s" is a quantity in kg m2 s; a length is wanted, e.g. "5 m")"},
           {"5 KN", "N", R"("KN" is no unit known here; did you mean "kN"?)"},
           {"5 Kg", "kg", R"("Kg" is no unit known here; did you mean "kg"?)"},
           {"5 Mm", "m", R"("Mm" is no unit known here; did you mean "mm"?)"},
           {"5 furlongs", "m", R"("furlongs" is no unit known here)"},
           {"5 x", "m", R"("x" is no unit known here)"},
           {"", "m", R"(empty; write e.g. "1 m")"},
           {"   ", "", R"(empty; write e.g. "1")"},
           {"mm", "m", R"("mm" is not a number; write e.g. "1 m")"},
           {"--5", "m", "is not a number"},
           {"+-5", "m", "is not a number"},
           {"nan", "m", R"("nan" is not a finite number)"},
           {"-inf", "m", R"("-inf" is not a finite number)"},
           {"inf m", "m", R"("inf m" is not a finite number)"},
           {".nan", "m", "is not a number"},
           {"1e400", "m", R"("1e400" is too large or too small for a number)"},
           {"1e308 km", "m", R"("1e308 km" is too large or too small for a number)"},
           {"2,5 m", "m", R"("2,5 m" has a comma; write a decimal point and no thousands separator)"},
           {"5 m m2/", "m3", R"(it ends with an operator)"},
           {"5 kg/m s2", "Pa", "write powers, as in \"kg m-1 s-2\""},
           {"5 m^", "m", "is no power"},
           {"5 m23", "m", "is no power"},
           {"5 m-", "m", "is no power"},
           {"5 5", "m", R"("5 5": "5" is not a unit)"},
           {"5 m2kg", "m", R"("kg" is not expected there)"},
           {"0x10", "m", R"("x" is no unit known here)"},
           {"5 kmin", "s", "\"kmin\" is no unit known here; did you mean \"min\"?"},
           {"5 \xff\xfe", "m", "is no unit known here"},
       }) {
    const Parsed<double> result = read_quantity(text, unit);
    EXPECT_FALSE(result.value.has_value()) << text;
    EXPECT_THAT(result.problem, HasSubstr(problem)) << text;
  }
}

TEST(Quantity, DoesNotDependOnTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* comma : {"de_DE.UTF-8", "fr_FR.UTF-8"}) std::setlocale(LC_ALL, comma);
  EXPECT_EQ(read_quantity("2.5 m", "m").value, 2.5);
  std::setlocale(LC_ALL, before.c_str());
}

TEST(Integer, ReadsWholeNumbersOnly) {
  EXPECT_EQ(read_integer("10000").value, 10000);
  EXPECT_EQ(read_integer("1e6").value, 1000000);
  EXPECT_EQ(read_integer("-3").value, -3);
  EXPECT_EQ(read_integer("9223372036854775807").value, 9223372036854775807);
  EXPECT_THAT(read_integer("1.5").problem, HasSubstr("\"1.5\" is not a whole number"));
  EXPECT_THAT(read_integer("ten").problem, HasSubstr("\"ten\" is not a whole number"));
  EXPECT_THAT(read_integer("").problem, HasSubstr("is not a whole number"));
  EXPECT_THAT(read_integer("1e300").problem, HasSubstr("too large"));
  EXPECT_FALSE(read_integer("nan").value.has_value());
}

}  // namespace
}  // namespace eigengrain::io
