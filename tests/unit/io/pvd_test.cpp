#include "bezel/io/pvd.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "bezel/base/error.hpp"
#include "bezel/base/random.hpp"
#include "support/message_of.hpp"

namespace bezel {
namespace {

using test::message_of;

std::string collection(const std::string& sets) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n" +
         sets + "</Collection>\n</VTKFile>\n";
}

TEST(Pvd, WrittenAndReadAgainIsTheSame) {
  RandomStream random("pvd", 1);
  std::vector<TimeStep> steps;
  for (int i = 0; i < 20; ++i)
    steps.push_back({(random.uniform() - 0.5) * 1e3, "a <b> & \"c\" '" + std::to_string(i)});
  steps.push_back({1e-310, "dir/file.vtu"});
  EXPECT_EQ(parse_pvd("x.pvd", encode_pvd(steps)), steps);
}

TEST(Pvd, WhatParaViewWritesIsRead) {
  const std::string text = collection(
      "<DataSet timestep=\"0\" group=\"\" part=\"0\" file=\"run/run_0.vtu\"/>\n"
      "<DataSet timestep=\"0.25\" part=\"0\" file=\"run/run_1.vtu\" name=\"x\"/>\n");
  const std::vector<TimeStep> expected = {{0.0, "run/run_0.vtu"}, {0.25, "run/run_1.vtu"}};
  EXPECT_EQ(parse_pvd("run.pvd", text), expected);
}

TEST(PvdErrors, NameFileAndLine) {
  const auto message = [](const std::string& text) {
    return message_of([&] { (void)parse_pvd("run.pvd", text); });
  };
  EXPECT_EQ(message("<a>"), "run.pvd:1: the XML cannot be read: start-end tags mismatch");
  EXPECT_EQ(message("<a/>"), "run.pvd: expected a VTKFile element at the top");
  EXPECT_EQ(message("<VTKFile type=\"UnstructuredGrid\"/>"),
            "run.pvd:1: a VTK file of type 'UnstructuredGrid', expected 'Collection'");
  EXPECT_EQ(message("<VTKFile type=\"Collection\"/>"),
            "run.pvd:1: VTKFile has no Collection element, expected one");
  EXPECT_EQ(message(collection("")), "run.pvd:3: no DataSet element, expected at least one");
  EXPECT_EQ(message(collection("<DataSet timestep=\"nan\" file=\"a\"/>")),
            "run.pvd:4: the time of step 0 is 'nan', expected a finite number");
  EXPECT_EQ(message(collection("<DataSet timestep=\"1e999\" file=\"a\"/>")),
            "run.pvd:4: the time of step 0 is '1e999', expected a finite number");
  EXPECT_EQ(message(collection("\n<DataSet timestep=\"1\"/>")),
            "run.pvd:5: step 0 names no file, expected one");
  EXPECT_EQ(message(collection("<DataSet timestep=\"1\" file=\"a\"/><DataSet timestep=\"1\" "
                               "part=\"1\" file=\"b\"/>")),
            "run.pvd:4: two files of time 1, expected one (a mesh in parts is not supported)");
  EXPECT_EQ(message_of([] { (void)encode_pvd({}); }), "found no time step, expected at least one");
  EXPECT_EQ(message_of([] {
              (void)encode_pvd({{std::numeric_limits<double>::infinity(), "a.vtu"}});
            }),
            "the time of 'a.vtu' is inf, expected a finite number");
  EXPECT_EQ(message_of([] { (void)read_pvd("no such.pvd"); }).substr(0, 27),
            "no such.pvd: cannot be read");
}

}  // namespace
}  // namespace bezel
