// What is asked for wrongly is refused before any work, in a sentence that names it: exit code 2.

#include <sstream>

#include "tests/commands/program_runner.h"

namespace freevoxels::test {

namespace {

struct WrongUse {
  const char* name;
  const char* arguments;
  const char* mention;
};

void PrintTo(const WrongUse& use, std::ostream* stream) {
  *stream << use.arguments;
}

class Usage : public CommandTest, public testing::WithParamInterface<WrongUse> {};

TEST_P(Usage, IsRefused) {
  expectCleanRefusal(GetParam().arguments, ExitCode::Usage, GetParam().mention);
}

constexpr WrongUse kWrongUses[] = {
    {"NoCommand", "", "a command is needed"},
    {"UnknownCommand", "draw procedural:cube @a.png", "'draw'"},
    {"NearCommand", "rendr procedural:cube @a.png", "did you mean 'render'?"},
    {"FileInPlaceOfACommand", "cloud.vdb", "freevoxels render cloud.vdb"},
    {"UnknownOption", "render procedural:cube @a.png --shiny", "--shiny"},
    {"NearOption", "render procedural:cube @a.png --szie 64x64", "did you mean '--size'?"},
    {"NearOptionWithValue", "render procedural:cube @a.png --orbt=1,2", "did you mean '--orbit'?"},
    {"UnknownColour", "render procedural:cube @a.png --albedo whit", "--albedo"},
    {"ShortColour", "render procedural:cube @a.png --albedo #fff", "--albedo"},
    {"NoInput", "render", "IN"},
    {"UnknownExtension", "render procedural:cube @a.bmp", "a.bmp"},
    {"NoExtension", "render procedural:cube @a", "extension"},
    {"ZeroSize", "render procedural:cube @a.png --size 0x64", "--size"},
    {"NegativeSize", "render procedural:cube @a.png --size 64x-64", "--size"},
    {"AbsurdSize", "render procedural:cube @a.png --size 1000000x1000000", "--size"},
    {"OverflowingSize", "render procedural:cube @a.png --size 99999999999999999999x1", "--size"},
    {"HalfASize", "render procedural:cube @a.png --size 64x", "--size"},
    {"FractionalSize", "render procedural:cube @a.png --size 64.5x64", "--size"},
    {"NanCamera", "render procedural:cube @a.png --camera-position nan,0,0", "--camera-position"},
    {"InfiniteCamera", "render procedural:cube @a.png --camera-position 0,0,inf", "--camera-position"},
    {"OverflowingCamera", "render procedural:cube @a.png --camera-position 0,0,1e999", "--camera-position"},
    {"NanLookAt", "render procedural:cube @a.png --look-at 0,nan,0", "--look-at"},
    {"NanUp", "render procedural:cube @a.png --up 0,nan,0", "--up"},
    {"ZeroUp", "render procedural:cube @a.png --up 0,0,0", "--up"},
    {"TwoCoordinates", "render procedural:cube @a.png --look-at 1,2", "--look-at"},
    {"FourCoordinates", "render procedural:cube @a.png --look-at 1,2,3,4", "--look-at"},
    {"TrailingComma", "render procedural:cube @a.png --look-at 1,2,", "--look-at"},
    {"CameraAtLookAt", "render procedural:cube @a.png --camera-position 1,2,3 --look-at 1,2,3", "look-at"},
    {"CameraAtVolumeCentre", "render procedural:cube @a.png --resolution 4 --camera-position 0,0,0", "look-at"},
    {"UpAlongView", "render procedural:cube @a.png --camera-position 0,5,0 --look-at 0,0,0", "--up"},
    {"OrbitAndPosition", "render procedural:cube @a.png --orbit 1,2 --camera-position 1,2,3", "--orbit"},
    {"NanOrbit", "render procedural:cube @a.png --orbit nan,2", "--orbit"},
    {"ZeroFov", "render procedural:cube @a.png --fov 0", "--fov"},
    {"StraightFov", "render procedural:cube @a.png --fov 180", "--fov"},
    {"NanFov", "render procedural:cube @a.png --fov nan", "--fov"},
    {"FlatOrthographic", "render procedural:cube @a.png --orthographic 0", "--orthographic"},
    {"FovAndOrthographic", "render procedural:cube @a.png --orthographic 1 --fov 20", "--orthographic"},
    {"NegativeScale", "render procedural:cube @a.png --density-scale -1", "--density-scale"},
    {"NanScale", "render procedural:cube @a.png --density-scale nan", "--density-scale"},
    {"BrightAlbedo", "render procedural:cube @a.png --albedo 2,0,0", "--albedo"},
    {"TwoClassifications", "render procedural:cube @a.png --albedo 1,0,0 --transfer-function @t.json", "--albedo"},
    {"WindowOfDensities", "render procedural:cube @a.png --density-scale 2 --window 1,2", "--window"},
    {"WindowWithoutWidth", "render procedural:cube @a.png --window 40,0", "--window"},
    {"WindowUpsideDown", "render procedural:cube @a.png --window 3..2", "--window"},
    {"WindowOfOneNumber", "render procedural:cube @a.png --window 3", "CENTER,WIDTH|LO..HI"},
    {"NoOpacity", "render procedural:cube @a.png --opacity 0", "--opacity"},
    {"NothingToInvert", "render procedural:cube @a.png --resolution 4 --invert", "--invert"},
    {"ConversionWithoutOutput", "convert-tf viridis", "OUT.json"},
    {"ConversionToXml", "convert-tf viridis @a.xml", ".json"},
    {"UnknownComposite", "render procedural:cube @a.png --composite summed", "'summed'"},
    {"UnknownAttenuation", "render procedural:cube @a.png --attenuation cubic", "'cubic'"},
    {"UnknownCode", "render procedural:cube @a.png --code float", "'float'"},
    {"NegativeLod", "render procedural:cube @a.png --lod -1", "--lod"},
    {"NanLod", "turntable procedural:cube @a_#.png --lod nan", "--lod"},
    {"UnknownHierarchyFilter", "render procedural:cube @a.png --hierarchy-filter median", "'median'"},
    {"UnknownAov", "render procedural:cube @a.exr --aov depth,colour", "'colour'"},
    {"DepthWithoutExr", "render procedural:cube @a.png --aov depth", "--aov"},
    {"FloatWithoutExr", "render procedural:cube @a.png --float", "--float"},
    {"BackgroundWithoutPng", "render procedural:cube @a.exr --background 0,0,0", "--background"},
    {"TransparencyOfExr", "render procedural:cube @a.exr --background transparent", "--background"},
    {"ExposureWithoutPng", "render procedural:cube @a.exr --exposure 1", "--exposure"},
    {"ToneMapWithoutPng", "render procedural:cube @a.exr --tone-map aces", "--tone-map"},
    {"UnknownToneMap", "render procedural:cube @a.png --tone-map log", "'log'"},
    {"HugeExposure", "render procedural:cube @a.png --exposure 99", "--exposure"},
    {"NanBackground", "render procedural:cube @a.png --background nan,0,0", "--background"},
    {"QuietAndVerbose", "render procedural:cube @a.png --quiet --verbose", "--verbose"},
    {"UnknownProcedural", "render procedural:teapot @a.png", "teapot"},
    {"NamelessProcedural", "render procedural: @a.png", "procedural"},
    {"GridOfProcedural", "render procedural:cube @a.png --grid density", "--grid"},
    {"ZeroResolution", "render procedural:cube @a.png --resolution 0", "--resolution"},
    {"ResolutionOfFile", "render @a.vdb @a.png --resolution 8", "--resolution"},
    {"NoFrames", "turntable procedural:cube @a_#.png --frames 0", "--frames"},
    {"NegativeFrames", "turntable procedural:cube @a_#.png --frames -3", "--frames"},
    {"AbsurdFrames", "turntable procedural:cube @a_#.png --frames 100001", "--frames"},
    {"HalfAFrame", "turntable procedural:cube @a_#.png --frames 1.5", "--frames"},
    {"FramesOfRender", "render procedural:cube @a.png --frames 3", "--frames"},
    {"NoRun", "turntable procedural:cube @a.png", "run of #"},
    {"TwoRuns", "turntable procedural:cube @a_#_##.png", "several runs"},
    {"OneOfTwoWithoutRun", "turntable procedural:cube @a_##.png @b.exr", "b.exr"},
    {"TurntableExtension", "turntable procedural:cube @a_##.bmp", ".bmp"},
    {"FramesThatMeet", "turntable procedural:cube @#.png @1#.png --frames 11", "same file"},
    {"TurntableAtItsAxis", "turntable procedural:cube @#.png --camera-position 0,5,0 --look-at 0,0,0", "--up"},
    {"GenerateNothing", "generate", "--list"},
    {"GenerateUnknown", "generate teapot @a.vdb", "teapot"},
    {"GenerateImage", "generate cube @a.png", ".vdb"},
    {"InfoOfNothing", "info", "IN"},
    {"DevicesWithInput", "devices procedural:cube", "procedural:cube"},
};

INSTANTIATE_TEST_SUITE_P(Commands, Usage, testing::ValuesIn(kWrongUses),
                         [](const auto& use) { return std::string(use.param.name); });

}  // namespace

TEST_F(CommandTest, EveryCommandHasHelpWithItsOptions) {
  for (const char* command : {"", "render", "turntable", "oracle", "compare", "info", "generate", "presets", "convert-tf", "devices"}) {
    const ProgramResult result = run(std::string(command) + " --help");
    expectSuccess(result);
    EXPECT_NE(result.out.find("--help"), std::string::npos);
    EXPECT_EQ(result.err, "");
  }
  EXPECT_NE(run("render --help").out.find("freevoxels render cloud.vdb"), std::string::npos);
}

/// The first word of each line that describes an option, with what follows it up to the blanks before its description.
std::vector<std::string> describedNames(const std::string& help) {
  std::vector<std::string> names;
  std::istringstream lines(help);
  bool describes = false;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("  ")) describes = line == "Positionals:" || (describes && line.empty());
    if (describes && line.starts_with("  ") && line[2] != ' ') names.push_back(line.substr(2, line.find("  ", 2) - 2));
  }
  return names;
}

/// CLI11 2.2 and later refuse others, before there is a handler for the exception.
TEST_F(CommandTest, NamesOfPositionalsAreWords) {
  std::size_t names = 0;
  const auto check = [&](const char* program, const Arguments& arguments) {
    for (const std::string& described : describedNames(runProgramFile(program, arguments).out)) {
      const std::string name = described.ends_with(" ...") ? described.substr(0, described.size() - 4) : described;
      EXPECT_EQ(name.find_first_of(" =:{!"), std::string::npos) << program << ": '" << name << "'";
      ++names;
    }
  };
  for (const char* command : {"render", "turntable", "merge", "oracle", "compare", "info", "generate", "bake", "convert-tf", "devices"})
    check(FREEVOXELS_PROGRAM, {command, "--help"});
  for (const char* program : {FREEVOXELS_VALIDATE_PROGRAM, FREEVOXELS_VIEW_PROGRAM}) check(program, {"--help"});
  EXPECT_GE(names, 12u);
}

TEST_F(CommandTest, VersionIsOneLine) {
  const ProgramResult result = run("--version");
  expectSuccess(result);
  EXPECT_TRUE(result.out.starts_with("freevoxels "));
  EXPECT_EQ(result.out.find('\n'), result.out.size() - 1);
}

}  // namespace freevoxels::test
