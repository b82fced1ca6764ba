// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

// What happens when OpenGL refuses, or what a picture is made of goes away. Each time: one message
// that says what and what to do, no crash, nothing half done; and once the fault is over, the
// frame, or the texels, of one that never met it, to the bit.

#include "Messages.h"
#include "OpenGLLoader.h"
#include "OpenGLRefusal.h"
#include "PassScene.h"
#include "SegmentLight.h"
#include "StabilityTools.h"
#include "SurfaceLight.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFloatArray.h"
#include "vtkHeadlessFactory.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkObjectFactoryCollection.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkRadianceMap.h"
#include "vtkRenderPass.h"
#include "vtkRenderStepsPass.h"
#include "vtkStructuredGrid.h"
#include "vtkTextureUnitManager.h"
#include "vtkVersionMacros.h"

// Windows of our own, which can do without OpenGL; from VTK 9.4 on they are VTK's.
#define HAS_HEADLESS_WINDOWS (VTK_VERSION_NUMBER < VTK_VERSION_CHECK(9, 4, 0))
#if HAS_HEADLESS_WINDOWS
#include "vtkHeadlessRenderWindow.h"
#endif

#include <gtest/gtest.h>

#include <algorithm>

namespace
{

using Choice = OpenGLRefusal::Choice;

/// A scene whose bake takes all stages.
TestScene MakeFaultScene()
{
  TestScene scene = MakeLampScene();
  scene.AddBox({ 0.3, -0.4, 0.3 }, { 0.8, 0.5, 0.7 });
  return scene;
}

/// Bakes that take every stage between them.
std::vector<TestScene> MakeFaultScenes()
{
  std::vector<TestScene> scenes(5, MakeFaultScene());
  scenes[0].Name = "plain bake";
  scenes[1].Name = "supersampled bake";
  scenes[1].Settings.Supersampling = 2;
  scenes[2].Name = "bake to a tolerance";
  scenes[2].Settings.ErrorTolerance = 1e-4;
  scenes[3].Name = "light of two hues";
  std::vector<penumbra::PolygonLight> cells(
    2, penumbra::PolygonLight::Parallelogram({ -0.5, 0.5, 2 }, { 0.5, 0.5, 2 }, { -0.5, -0.5, 2 }));
  cells[0].Radiance = { 1.0, 0.1, 0.0 };
  cells[1].Radiance = { 0.0, 0.4, 0.5 };
  scenes[3].Lights = { penumbra::SurfaceLight(cells) };
  scenes[4].Name = "light whose closed form is computed in double";
  scenes[4].Lights = { penumbra::SegmentLight({ -1.0, -0.5, 2.0 }, { 1.0, 0.2, 2.4 }) };
  return scenes;
}

/// A bake of the scene's receiver; without texels, if it is not complete.
std::vector<glm::vec4> BakeIfPossible(const TestScene& scene, vtkOpenGLRenderWindow* window)
{
  vtkNew<vtkRadianceBaker> baker;
  vtkNew<vtkRadianceTexture> texture;
  const auto reports = baker->Bake(scene.MakeScene(), { 0 }, window, texture);
  std::vector<glm::vec4> texels;
  if (!reports.empty() && reports.front().IsComplete)
  {
    texels = texture->Download(texture->GetRegions().front()).Irradiance;
  }
  texture->ReleaseGraphicsResources();
  return texels;
}

/// Refuses the first, the second ... call of the kind in turn, until no bake asks for so many. The
/// answer is how many there are. A bake may do without: a buffer of samples that grows stays with
/// its texture. It is then as good as any.
int RefuseEachInTurn(const TestScene& scene, OpenGLCall::Kind kind)
{
  vtkOpenGLRenderWindow* window = GetTestWindow();
  const std::vector<glm::vec4> good = BakeIfPossible(scene, window);
  EXPECT_FALSE(good.empty());
  for (int refused = 0;; ++refused)
  {
    const Messages messages;
    std::vector<glm::vec4> texels;
    int count = 0;
    {
      const OpenGLRefusal refusal(
        [&](const OpenGLCall& call) { return call.What == kind && call.Index == refused; });
      texels = BakeIfPossible(scene, window);
      count = refusal.GetCount();
    }
    if (count == 0)
    {
      EXPECT_EQ(texels, good) << scene.Name;
      return refused;
    }
    if (texels.empty())
    {
      messages.ExpectOne({ "OpenGL refused" });
    }
    else
    {
      EXPECT_EQ(kind, OpenGLCall::TextureBuffer);
      EXPECT_EQ(texels, good) << scene.Name << ": half baked without call " << refused;
      EXPECT_EQ(messages.GetText(), "");
    }
    EXPECT_EQ(BakeIfPossible(scene, window), good) << scene.Name << ": after call " << refused;
  }
}

void ExpectRefusalsAreReported(OpenGLCall::Kind kind, const std::string& what, int fewest)
{
  for (const TestScene& scene : MakeFaultScenes())
  {
    const int refused = RefuseEachInTurn(scene, kind);
    std::cout << scene.Name << ": " << refused << " " << what << ", each refused once\n";
    EXPECT_GE(refused, fewest) << scene.Name;
  }
}

/// A window with a context, in which nothing has been compiled.
vtkSmartPointer<vtkRenderWindow> MakeWindow(int width = 300, int height = 200)
{
  auto window = vtkSmartPointer<vtkRenderWindow>::New();
  window->SetMultiSamples(0);
  window->SetSize(width, height);
  return window;
}

/// A fault in a view, by what OpenGL refuses, and words that the message must have.
struct ViewFault
{
  std::string Stage;
  Choice Refused;
  std::vector<std::string> Words;
  std::function<void(FloorScene&)> Prepare = [](FloorScene&) {};
};

Choice RefuseFormat(unsigned int format, int index = 0)
{
  return [=, seen = 0](const OpenGLCall& call) mutable
  { return call.What == OpenGLCall::Texture && call.Format == format && seen++ == index; };
}

Choice RefuseFirst(OpenGLCall::Kind kind)
{
  return [=](const OpenGLCall& call) { return call.What == kind && call.Index == 0; };
}

Choice RefuseShader(const std::string& word)
{
  return [=](const OpenGLCall& call)
  { return call.What == OpenGLCall::Shader && call.Source.find(word) != std::string::npos; };
}

/// Three frames while OpenGL refuses are plain and there is one message; then the receiver is
/// touched, and the frame is that of a view that never met a fault.
void ExpectPlainThenGood(const ViewFault& fault)
{
  FloorScene untouched, plain, scene;
  for (FloorScene* each : { &untouched, &plain, &scene })
  {
    fault.Prepare(*each);
  }
  const PassScene::Pixels good = untouched.Render();
  plain.SetShadows(false);
  const PassScene::Pixels unshadowed = plain.Render();
  ASSERT_GT(CountDifferences(good, unshadowed), 0u);
  vtkOpenGLRenderWindow::SafeDownCast(scene.Window)->Initialize();
  int refused = 0;
  double wrong = 0.0;
  {
    const Messages messages;
    const OpenGLRefusal refusal(fault.Refused);
    for (int frame = 0; frame < 3; ++frame)
    {
      wrong += static_cast<double>(CountDifferences(scene.Render(), unshadowed));
    }
    refused = refusal.GetCount();
    for (const std::string& word : fault.Words)
    {
      EXPECT_EQ(messages.Count(word), 1) << fault.Stage << ": " << messages.GetText();
    }
  }
  EXPECT_GT(refused, 0) << fault.Stage << ": nothing was refused";
  ExpectWithin(fault.Stage + ": pixels of refused frames that are not plain", wrong, 0.0);
  scene.Receiver->Modified();
  ExpectWithin(fault.Stage + ": pixels of the next good frame that differ",
    static_cast<double>(CountDifferences(scene.Render(), good)), 0.0);
}

#if HAS_HEADLESS_WINDOWS
/// A window that gets no context while a test says so.
class NoOpenGLWindow : public vtkHeadlessRenderWindow
{
public:
  static NoOpenGLWindow* New();
  vtkTypeMacro(NoOpenGLWindow, vtkHeadlessRenderWindow)
  void MakeCurrent() override {}
  void ReleaseCurrent() override {}
  bool IsCurrent() override { return false; }
  vtkTypeBool IsDirect() override { return 0; }

protected:
  std::string CreateContext() override { return "this test has no OpenGL"; }
  void DestroyContext() override {}
  std::function<void()> RememberCurrentContext() override { return {}; }
};
vtkStandardNewMacro(NoOpenGLWindow);
VTK_CREATE_CREATE_FUNCTION(NoOpenGLWindow);

/// Makes the windows of the process such ones while it lives.
class WithoutOpenGL
{
public:
  WithoutOpenGL()
  {
    vtkHeadlessFactory::RegisterWindow("NoOpenGLWindow", vtkObjectFactoryCreateNoOpenGLWindow);
  }
  ~WithoutOpenGL()
  {
    vtkObjectFactoryCollection* factories = vtkObjectFactory::GetRegisteredFactories();
    vtkObjectFactory::UnRegisterFactory(vtkObjectFactory::SafeDownCast(
      factories->GetItemAsObject(factories->GetNumberOfItems() - 1)));
    vtkObjectFactory::SetAllEnableFlags(1, "vtkRenderWindow", "vtkHeadlessOSMesaRenderWindow");
    vtkObjectFactory::SetAllEnableFlags(
      1, "vtkRenderWindowInteractor", "vtkGenericRenderWindowInteractor");
  }
};
#endif

/// Two floors under a lamp and a sphere, as data.
struct FaultMap
{
  FaultMap()
  {
    for (int i = 0; i < 2; ++i)
    {
      this->Planes[i]->SetOrigin(-2, -2, -0.5 * i);
      this->Planes[i]->SetPoint1(2, -2, -0.5 * i);
      this->Planes[i]->SetPoint2(-2, 2, -0.5 * i);
      this->Receivers[i]->SetInputConnection(this->Planes[i]->GetOutputPort());
      this->Receivers[i]->SetTexelSize(i == 0 ? 4.0 / 40 : 4.0 / 24);
      this->Map->AddInputConnection(vtkRadianceMap::RECEIVERS, this->Receivers[i]->GetOutputPort());
    }
    this->Sphere->SetCenter(0.3, 0.1, 0.8);
    this->Light->SetOrigin(-0.5, 0.5, 3.0);
    this->Light->SetPoint1(0.5, 0.5, 3.0);
    this->Light->SetPoint2(-0.5, -0.5, 3.0);
    this->Map->AddInputConnection(vtkRadianceMap::OCCLUDERS, this->Sphere->GetOutputPort());
    this->Map->AddInputConnection(vtkRadianceMap::LIGHTS, this->Light->GetOutputPort());
  }

  /// All values of all blocks' cells.
  std::vector<std::vector<double>> Bake()
  {
    this->Map->Modified();
    this->Map->Update();
    std::vector<std::vector<double>> blocks;
    for (unsigned int b = 0; b < this->Map->GetOutput()->GetNumberOfBlocks(); ++b)
    {
      auto* grid = vtkStructuredGrid::SafeDownCast(this->Map->GetOutput()->GetBlock(b));
      std::vector<double>& values = blocks.emplace_back();
      for (int a = 0; a < grid->GetCellData()->GetNumberOfArrays(); ++a)
      {
        vtkDataArray* array = grid->GetCellData()->GetArray(a);
        for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
        {
          for (int c = 0; c < array->GetNumberOfComponents(); ++c)
          {
            values.push_back(array->GetComponent(i, c));
          }
        }
      }
    }
    return blocks;
  }

  vtkNew<vtkPlaneSource> Planes[2];
  vtkNew<vtkShadowReceiver> Receivers[2];
  vtkNew<vtkSphereSource> Sphere;
  vtkNew<vtkAreaLightSource> Light;
  vtkNew<vtkRadianceMap> Map;
};

/// Draws what it is told to after it has done something else: what happens between bake and draw.
class MeddlingPass : public vtkRenderPass
{
public:
  static MeddlingPass* New();
  vtkTypeMacro(MeddlingPass, vtkRenderPass)
  void Render(const vtkRenderState* s) override
  {
    if (this->Meddle)
    {
      this->Meddle();
    }
    this->Steps->Render(s);
  }
  void ReleaseGraphicsResources(vtkWindow* window) override
  {
    this->Steps->ReleaseGraphicsResources(window);
  }

  std::function<void()> Meddle;
  vtkNew<vtkRenderStepsPass> Steps;
};
vtkStandardNewMacro(MeddlingPass);

void ExpectSameFrame(
  const std::string& what, const PassScene::Pixels& a, const PassScene::Pixels& b)
{
  ExpectWithin(what + ": pixels that differ", static_cast<double>(CountDifferences(a, b)), 0.0);
}

} // namespace

TEST(StabilityFault, AnyTextureRefused)
{
  // Radiance and its variance, a closed form, a share, masks.
  ExpectRefusalsAreReported(OpenGLCall::Texture, "textures", 5);
}

TEST(StabilityFault, AnyBufferRefused)
{
  // Vertices, indices and samples.
  ExpectRefusalsAreReported(OpenGLCall::Buffer, "buffers", 3);
}

TEST(StabilityFault, AnyTextureBufferRefused)
{
  ExpectRefusalsAreReported(OpenGLCall::TextureBuffer, "texture buffers", 1);
}

TEST(StabilityFault, AnyDrawRefused)
{
  // Masks, their shares, what is unoccluded and what is not.
  ExpectRefusalsAreReported(OpenGLCall::Draw, "draws", 4);
}

TEST(StabilityFault, NoTextureUnitIsFree)
{
  const TestScene scene = MakeFaultScene();
  vtkOpenGLRenderWindow* window = GetTestWindow();
  const std::vector<glm::vec4> good = BakeIfPossible(scene, window);
  vtkTextureUnitManager* units = window->GetState()->GetTextureUnitManager();
  for (int free = 0; free < 8; ++free)
  {
    std::vector<int> taken;
    for (int unit = units->Allocate(); unit >= 0; unit = units->Allocate())
    {
      taken.push_back(unit);
    }
    for (int i = 0; i < free; ++i)
    {
      units->Free(taken.back());
      taken.pop_back();
    }
    std::vector<glm::vec4> texels;
    {
      const Messages messages;
      texels = BakeIfPossible(scene, window);
      EXPECT_EQ(texels.empty(), messages.Count("ERROR") > 0) << messages.GetText();
    }
    EXPECT_TRUE(texels.empty() || texels == good) << "half baked with " << free << " units";
    EXPECT_TRUE(!texels.empty() || free < 7) << "seven are enough";
    for (const int unit : taken)
    {
      units->Free(unit);
    }
    EXPECT_EQ(BakeIfPossible(scene, window), good) << "after a bake with " << free << " units";
  }
}

// Shaders are compiled once for a window: each bake is the first one of its own.
TEST(StabilityFault, AnyShaderRefused)
{
  TestScene scene = MakeFaultScene();
  scene.Settings.Supersampling = 2;
  const std::vector<glm::vec4> good = BakeIfPossible(scene, GetTestWindow());
  int refused = 0;
  for (bool isDone = false; !isDone; ++refused)
  {
    const vtkSmartPointer<vtkRenderWindow> made = MakeWindow(16, 16);
    auto* window = vtkOpenGLRenderWindow::SafeDownCast(made);
    window->Initialize();
    window->MakeCurrent();
    std::vector<glm::vec4> texels;
    {
      const Messages messages;
      const OpenGLRefusal refusal([&](const OpenGLCall& call)
        { return call.What == OpenGLCall::Shader && call.Index == refused; });
      texels = BakeIfPossible(scene, window);
      isDone = refusal.GetCount() == 0;
      // VTK prints the source and says what is wrong with it; the rest is ours.
      EXPECT_EQ(messages.Count("did not compile"), isDone ? 0 : 1) << messages.GetText();
      EXPECT_EQ(messages.Count("update the OpenGL driver"), isDone ? 0 : 1);
    }
    EXPECT_EQ(texels.empty(), !isDone) << "shader " << refused;
    EXPECT_EQ(BakeIfPossible(scene, window), good) << "after shader " << refused;
  }
  std::cout << refused - 1 << " shaders, each refused once\n";
  // A vertex and a fragment shader for masks, shares, closed form, sum and fine texels.
  EXPECT_GE(refused - 1, 10);
}

TEST(StabilityFault, ViewIsPlainWithoutATexture)
{
  const auto toRadiance = [](FloorScene& s) { s.Pass->SetShading(vtkSoftShadowPass::RADIANCE); };
  const auto supersample = [](FloorScene& s) { s.Receiver->SetSupersampling(2); };
  const auto toTolerance = [](FloorScene& s) { s.Receiver->SetErrorTolerance(1e-4); };
  const std::vector<std::string> texture{ "ERROR", "OpenGL refused a texture", "TexelSize" };
  const std::vector<std::string> mipmaps{ "ERROR", "OpenGL refused the mip levels", "TexelSize" };
  for (const ViewFault& fault :
    std::vector<ViewFault>{ { "radiance", RefuseFormat(GL_RGBA32F), texture },
      { "variance", RefuseFormat(GL_R32F), texture, toTolerance },
      { "masks", RefuseFormat(GL_R32UI), { "ERROR", "OpenGL refused a mask", "fewer" } },
      { "closed form", RefuseFormat(GL_RGBA32F, 1), texture },
      { "share", RefuseFormat(GL_RG32F), texture },
      { "shadow factors", RefuseFormat(GL_RGB10_A2), texture },
      { "mip levels of factors", RefuseFirst(OpenGLCall::Mipmaps), mipmaps },
      { "mip levels of radiance", RefuseFirst(OpenGLCall::Mipmaps), mipmaps, toRadiance },
      { "fine radiance", RefuseFormat(GL_RGBA32F, 1), texture, supersample },
      { "scratch of a tolerance", RefuseFormat(GL_R32F, 1), texture, toTolerance },
      { "shares of batches", RefuseFormat(GL_RGBA32F, 3), texture, toTolerance },
      { "samples", RefuseFirst(OpenGLCall::TextureBuffer),
        { "ERROR", "OpenGL refused a buffer", "fewer" } },
      { "samples or triangles", RefuseFirst(OpenGLCall::Buffer),
        { "ERROR", "OpenGL refused", "fewer" } } })
  {
    ExpectPlainThenGood(fault);
  }
}

TEST(StabilityFault, ViewIsPlainWithoutAShader)
{
  const auto supersample = [](FloorScene& s) { s.Receiver->SetSupersampling(2); };
  for (const ViewFault& fault :
    std::vector<ViewFault>{ { "shader of masks", RefuseShader("uniform vec3 registration"), {} },
      { "shader of the closed form", RefuseShader("lightVertexCount"), {} },
      { "shader of shares", RefuseShader("usampler2DArray masks"), {} },
      { "shader that resolves", RefuseShader("uniform int hasShares"), {} },
      { "shader of fine texels", RefuseShader("uniform int factor"), {}, supersample },
      { "shader of factors", RefuseShader("uniform float scale"), {} },
      { "shader of receivers", RefuseShader("uniform sampler2D penumbraTexture"), {} } })
  {
    ViewFault named = fault;
    named.Words = { "did not compile", "update the OpenGL driver" };
    ExpectPlainThenGood(named);
  }
}

namespace
{

/// Draws frames until nothing is a draft any more, or for a bounded number of them.
PassScene::Pixels RenderUntilFinal(FloorScene& scene)
{
  constexpr int MostFrames = 1000;
  PassScene::Pixels pixels = scene.Render();
  for (int i = 0; i < MostFrames && scene.Pass->GetBakeProgress() < 1.0; ++i)
  {
    pixels = scene.Render();
  }
  return pixels;
}

/// A view whose draft has been drawn: the next frames are batches of a bake.
void DrawDraft(FloorScene& scene)
{
  scene.Receiver->SetTexelSize(4.0 / 24);
  scene.Pass->SetBakeMode(vtkSoftShadowPass::PROGRESSIVE);
  scene.Pass->SetBatchSeconds(1e-3); // several frames
  scene.Render();
}

} // namespace

// When a call of a batch is refused, the frames after it are plain or go on, and when the
// receiver is touched they are those of a view that never met a fault.
TEST(StabilityFault, BatchesSurviveRefusals)
{
  FloorScene untouched;
  DrawDraft(untouched);
  const PassScene::Pixels good = RenderUntilFinal(untouched);
  for (const OpenGLCall::Kind kind :
    { OpenGLCall::Texture, OpenGLCall::Buffer, OpenGLCall::TextureBuffer, OpenGLCall::Mipmaps })
  {
    for (int refused = 0;; ++refused)
    {
      FloorScene scene;
      DrawDraft(scene);
      ASSERT_LT(scene.Pass->GetBakeProgress(), 1.0);
      int count = 0;
      {
        const Messages messages;
        const OpenGLRefusal refusal(
          [&](const OpenGLCall& call) { return call.What == kind && call.Index == refused; });
        RenderUntilFinal(scene);
        count = refusal.GetCount();
        EXPECT_LE(messages.Count("ERROR"), 1) << messages.GetText();
      }
      EXPECT_EQ(scene.Pass->GetBakeProgress(), 1.0) << "kind " << kind << ", call " << refused;
      scene.Receiver->Modified();
      EXPECT_EQ(CountDifferences(RenderUntilFinal(scene), good), 0u)
        << "kind " << kind << ", after call " << refused;
      if (count == 0)
      {
        std::cout << refused << " calls of kind " << kind << ", each refused once\n";
        break;
      }
    }
  }
}

// Masks of a tile that is half drawn go with their prop.
TEST(StabilityFault, APropThatGoesInATileLeavesNoNames)
{
  FloorScene scene;
  DrawDraft(scene);
  const auto countNames = [&]
  {
    scene.Window->MakeCurrent();
    constexpr GLuint MostNames = 4096;
    int count = 0;
    for (GLuint name = 1; name < MostNames; ++name)
    {
      count += glIsTexture(name) + glIsFramebuffer(name);
    }
    return count;
  };
  const auto drawAndRemove = [&]
  {
    scene.Receiver->SetSeed(scene.Receiver->GetSeed() + 1);
    scene.Render();
    scene.Render(); // a batch has begun
    EXPECT_LT(scene.Pass->GetBakeProgress(), 1.0);
    scene.Renderer->RemoveActor(scene.FloorActor);
    scene.Render();
    scene.Renderer->AddActor(scene.FloorActor);
  };
  drawAndRemove();
  const int before = countNames();
  constexpr int Times = 5;
  for (int i = 0; i < Times; ++i)
  {
    drawAndRemove();
  }
  EXPECT_EQ(countNames(), before);
}

// Of two receivers, the one whose textures are refused is left out, and the other one is as ever.
TEST(StabilityFault, MapLeavesOutTheReceiverThatIsRefused)
{
  FaultMap map;
  const auto good = map.Bake();
  ASSERT_EQ(good.size(), 2u);
  {
    const Messages messages;
    const OpenGLRefusal refusal([](const OpenGLCall& call)
      { return call.What == OpenGLCall::Texture && call.Format == GL_R32UI && call.Width > 24; });
    const auto others = map.Bake();
    ASSERT_EQ(others.size(), 1u);
    EXPECT_EQ(others[0], good[1]);
    messages.ExpectOne({ "OpenGL refused a mask of", "texels for 64 samples", "fewer" });
  }
  EXPECT_EQ(map.Bake(), good);
}

#if HAS_HEADLESS_WINDOWS
TEST(StabilityFault, MapWithoutOpenGL)
{
  FaultMap map;
  {
    const WithoutOpenGL without;
    const Messages messages;
    EXPECT_TRUE(map.Bake().empty());
    EXPECT_EQ(messages.Count("RadianceMap: there is no OpenGL 3.2"), 1) << messages.GetText();
    EXPECT_EQ(messages.Count("this test has no OpenGL"), 1);
  }
  FaultMap untouched;
  EXPECT_EQ(map.Bake(), untouched.Bake());
}

TEST(StabilityFault, ViewWithoutOpenGL)
{
  FloorScene untouched, scene;
  const PassScene::Pixels good = untouched.Render();
  {
    const Messages messages;
    const auto window = vtkSmartPointer<NoOpenGLWindow>::New();
    scene.Window->RemoveRenderer(scene.Renderer);
    window->AddRenderer(scene.Renderer);
    window->Render();
    window->Render();
    window->RemoveRenderer(scene.Renderer);
    messages.ExpectOne({ "No OpenGL context, nothing will be drawn", "this test has no OpenGL" });
  }
  scene.Window->AddRenderer(scene.Renderer);
  ExpectSameFrame("after a window without OpenGL", scene.Render(), good);
}
#endif

TEST(StabilityFault, BakeWithoutCurrentContext)
{
  const TestScene scene = MakeFaultScene();
  vtkOpenGLRenderWindow* window = GetTestWindow();
  const std::vector<glm::vec4> good = BakeIfPossible(scene, window);
  {
    const Messages messages;
    window->ReleaseCurrent();
    EXPECT_TRUE(BakeIfPossible(scene, window).empty());
    messages.ExpectOne({ "No OpenGL context is current", window->GetClassName() });
  }
  EXPECT_EQ(BakeIfPossible(scene, GetTestWindow()), good);
}

// A lost context raises an error whenever it is asked: that must end, and nothing is believed.
TEST(StabilityFault, ContextLostInABake)
{
  const TestScene scene = MakeFaultScene();
  const std::vector<glm::vec4> good = BakeIfPossible(scene, GetTestWindow());
  {
    const Messages messages;
    const LostContext lost;
    EXPECT_TRUE(BakeIfPossible(scene, GetTestWindow()).empty());
    // VTK's own reports of errors, of which there are many, are not ours.
    EXPECT_EQ(messages.Count("OpenGL refused a texture"), 1) << messages.GetText();
  }
  EXPECT_EQ(BakeIfPossible(scene, GetTestWindow()), good);
}

TEST(StabilityFault, ContextOfAViewIsMadeAnew)
{
  FloorScene scene;
  const PassScene::Pixels good = scene.Render();
  const Messages messages;
  scene.Window->Finalize();
  EXPECT_EQ(scene.Pass->GetTexels(0), nullptr);
  EXPECT_EQ(scene.Pass->GetTextureBytes(), 0);
  ExpectSameFrame("after Finalize()", scene.Render(), good);
  scene.Window->WindowRemap();
  ExpectSameFrame("after WindowRemap()", scene.Render(), good);
  scene.Window->Finalize();
  scene.Pass->SetBakeMode(vtkSoftShadowPass::DRAFT);
  scene.Render();
  scene.Pass->SetBakeMode(vtkSoftShadowPass::COMPLETE);
  ExpectSameFrame("after Finalize() and a draft", scene.Render(), good);
  EXPECT_EQ(messages.GetText(), "");
}

// With its renderer, or after that has left it: then nobody tells the pass.
TEST(StabilityFault, WindowDestroyedWithThePassAlive)
{
  for (const bool leaves : { false, true })
  {
    FloorScene scene, untouched;
    const PassScene::Pixels good = untouched.Render();
    const Messages messages;
    vtkSmartPointer<vtkRenderWindow> window = MakeWindow();
    scene.Window->RemoveRenderer(scene.Renderer);
    window->AddRenderer(scene.Renderer);
    ExpectSameFrame("in a window of its own", DrawFrame(window), good);
    ASSERT_NE(scene.Pass->GetTexels(0), nullptr);
    if (leaves)
    {
      window->RemoveRenderer(scene.Renderer);
    }
    window = nullptr;
    EXPECT_EQ(scene.Pass->GetTexels(0), nullptr);
    scene.Window->AddRenderer(scene.Renderer);
    ExpectSameFrame("in the next window", scene.Render(), good);
    EXPECT_EQ(messages.GetText(), "");
  }
}

TEST(StabilityFault, ReleasedResourcesAreMadeAgain)
{
  FloorScene scene;
  const PassScene::Pixels good = scene.Render();
  for (const int shading : { vtkSoftShadowPass::SHADOW, vtkSoftShadowPass::RADIANCE })
  {
    scene.Pass->SetShading(shading);
    const PassScene::Pixels before = scene.Render();
    const int bakes = scene.Pass->GetBakeCount();
    scene.Pass->ReleaseGraphicsResources(scene.Window);
    EXPECT_EQ(scene.Pass->GetTextureBytes(), 0);
    ExpectSameFrame("after ReleaseGraphicsResources()", scene.Render(), before);
    EXPECT_EQ(scene.Pass->GetBakeCount(), bakes + 1);
  }
  scene.Pass->SetShading(vtkSoftShadowPass::SHADOW);
  // Another window's: nothing of this one's goes.
  const auto other = MakeWindow();
  scene.Pass->ReleaseGraphicsResources(other);
  EXPECT_GT(scene.Pass->GetTextureBytes(), 0);
  ExpectSameFrame("after the release of another window's", scene.Render(), good);
}

// Each window has a view of its own through the same pass; one of them goes first.
TEST(StabilityFault, TwoWindowsShareAPass)
{
  FloorScene first, untouchedFirst;
  auto second = std::make_unique<FloorScene>();
  auto untouchedSecond = std::make_unique<FloorScene>();
  for (FloorScene* scene : { second.get(), untouchedSecond.get() })
  {
    scene->Sphere->SetCenter(-0.7, 0.4, 0.6);
    scene->Window->SetSize(211, 147);
  }
  const PassScene::Pixels goodFirst = untouchedFirst.Render();
  const PassScene::Pixels goodSecond = untouchedSecond->Render();
  second->Renderer->SetPass(first.Pass);
  const Messages messages;
  for (int frame = 0; frame < 3; ++frame)
  {
    ExpectSameFrame("first window", first.Render(), goodFirst);
    ExpectSameFrame("second window", second->Render(), goodSecond);
  }
  second = nullptr;
  ExpectSameFrame("first window, alone", first.Render(), goodFirst);
  EXPECT_EQ(messages.GetText(), "");
}

// The same actors in two windows, by one pass.
TEST(StabilityFault, TwoWindowsShowTheSameActorsByOnePass)
{
  FloorScene scene;
  if (scene.Window->IsA("vtkEGLRenderWindow"))
  {
    GTEST_SKIP() << "VTK cannot show an actor in two windows of EGL, with or without a pass: it "
                    "frees what was of one window while it draws in the other one, and stays in "
                    "the first one's context, since their PopContext() does nothing (9.6).";
  }
  const PassScene::Pixels good = scene.Render();
  const auto other = MakeWindow();
  vtkNew<vtkRenderer> renderer;
  other->AddRenderer(renderer);
  renderer->SetBackground(scene.Renderer->GetBackground());
  renderer->SetActiveCamera(scene.Renderer->GetActiveCamera());
  renderer->SetPass(scene.Pass);
  for (vtkActor* actor : { scene.FloorActor, scene.LightActor, scene.SphereActor })
  {
    renderer->AddActor(actor);
  }
  for (int frame = 0; frame < 2; ++frame)
  {
    ExpectSameFrame("the other window", DrawFrame(other), good);
    ExpectSameFrame("the first window", scene.Render(), good);
  }
}

TEST(StabilityFault, ReceiverDeletedWhileItIsADraft)
{
  FloorScene scene;
  scene.Render();
  scene.Pass->SetBakeMode(vtkSoftShadowPass::DRAFT);
  scene.Sphere->SetRadius(0.4);
  scene.Render();
  scene.Sphere->SetRadius(0.5);
  scene.Renderer->RemoveActor(scene.FloorActor);
  scene.FloorActor = nullptr;
  const Messages messages;
  const PassScene::Pixels without = scene.Render();
  EXPECT_EQ(scene.Pass->GetNumberOfReceivers(), 0);
  FloorScene untouched;
  const PassScene::Pixels good = untouched.Render();
  untouched.FloorActor->VisibilityOff();
  ExpectSameFrame("without the receiver", without, untouched.Render());
  scene.Pass->SetBakeMode(vtkSoftShadowPass::COMPLETE);
  scene.FloorActor = scene.Add(scene.Receiver);
  ExpectSameFrame("with a new one", scene.Render(), good);
  EXPECT_EQ(messages.GetText(), "");
}

// What was baked is drawn as it was baked, or not at all; the next frame knows of the change.
TEST(StabilityFault, InputsChangedBetweenBakeAndDraw)
{
  const std::vector<std::pair<std::string, std::function<void(FloorScene&)>>> changes{
    { "sphere moved", [](FloorScene& s) { s.Sphere->SetCenter(0.5, 0.3, 0.9); } },
    { "floor without data", [](FloorScene& s) { s.FloorActor->GetMapper()->RemoveAllInputs(); } },
    { "floor without a mapper", [](FloorScene& s) { s.FloorActor->SetMapper(nullptr); } },
    { "sphere deleted",
      [](FloorScene& s)
      {
        s.SphereActor->GetMapper()->RemoveAllInputs();
        s.Renderer->RemoveActor(s.SphereActor);
      } },
    { "light removed", [](FloorScene& s) { s.Renderer->RemoveActor(s.LightActor); } },
    { "floor coarser", [](FloorScene& s) { s.Receiver->SetTexelSize(0.25); } },
    { "floor removed", [](FloorScene& s) { s.Renderer->RemoveActor(s.FloorActor); } },
    { "pass's resources released",
      [](FloorScene& s) { s.Pass->ReleaseGraphicsResources(s.Window); } }
  };
  for (const auto& [name, change] : changes)
  {
    FloorScene scene, untouched;
    change(untouched);
    const PassScene::Pixels good = untouched.Render();
    vtkNew<MeddlingPass> meddling;
    scene.Pass->SetDelegatePass(meddling);
    scene.Render();
    meddling->Meddle = [&, &apply = change]() { apply(scene); };
    scene.Receiver->Modified(); // so that there is a bake
    scene.Render();
    meddling->Meddle = nullptr;
    ExpectSameFrame(name + ", the frame after", scene.Render(), good);
  }
}
