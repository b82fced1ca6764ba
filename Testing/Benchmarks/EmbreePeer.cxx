// SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
// SPDX-License-Identifier: BSD-3-Clause

#include "EmbreePeer.h"

#include "BenchmarkTools.h"

#if PENUMBRA_EMBREE_VERSION >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>
#include <thread>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace
{

constexpr int Lanes = 16;

// Rays leave the receiver at this share of their length, some 100 times the rounding of a float.
constexpr float RayStart = 1e-5f;

/// 16 numbers, a lane each, that compilers keep in vector registers.
template <typename T>
struct alignas(64) Packet
{
  T Lane[Lanes];
};

/// Sobol's first two dimensions with their bits in reverse: the first bit after the point is bit 0.
using SobolPoint = std::array<std::uint32_t, 2>;

/// Whether a point comes first along Morton's curve, which goes through one half of the square
/// before the other, and so on in each half.
bool IsBefore(const SobolPoint& a, const SobolPoint& b)
{
  const std::uint32_t x = a[0] ^ b[0], y = a[1] ^ b[1];
  // The lowest bit that differs decides; of the two of a level, that of x.
  const std::uint32_t lowestX = x & (0u - x), lowestY = y & (0u - y);
  const bool byX = lowestX != 0 && (lowestY == 0 || lowestX <= lowestY);
  return byX ? (b[0] & lowestX) != 0 : (b[1] & lowestY) != 0;
}

/**
 * The first points of the sequence along Morton's curve: any 16 in turn (or another power of two)
 * are those of one dyadic cell. An Owen scramble exchanges such cells and keeps their points
 * together, so that rays to them stay coherent.
 */
std::vector<SobolPoint> MakeSobolPoints(int count)
{
  std::vector<SobolPoint> points;
  for (std::uint32_t index = 0; index < static_cast<std::uint32_t>(count); ++index)
  {
    // The first dimension is the index itself. The second is the index times Pascal's triangle
    // modulo 2, whose next column is this one xor itself moved by a bit.
    std::uint32_t second = 0, column = 1;
    for (std::uint32_t rest = index; rest != 0; rest >>= 1, column ^= column << 1)
    {
      second ^= (rest & 1u) * column;
    }
    points.push_back({ index, second });
  }
  std::sort(points.begin(), points.end(), IsBefore);
  return points;
}

/**
 * A nested uniform (Owen) scramble of reversed bits: each is flipped by a hash of those below it
 * (Laine and Karras 2011; constants by Vegdahl 2021). The answer is a number in [0, 1).
 */
inline float Scramble(std::uint32_t x, std::uint32_t seed)
{
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
  x = (x >> 16) | (x << 16);
  // 24 bits are a float's.
  return static_cast<float>(static_cast<std::int32_t>(x >> 8)) * 0x1p-24f;
}

std::uint32_t Mix(std::uint32_t x)
{
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

/// Lambert's formula for a parallelogram wholly above the horizon of x.
double GetFormFactor(
  const glm::dvec3& x, const glm::dvec3& normal, const penumbra::Parallelogram& light)
{
  const glm::dvec3 corner = light.Corner - x;
  const std::array<glm::dvec3, 4> vertices{ corner, corner + light.EdgeX,
    corner + light.EdgeX + light.EdgeY, corner + light.EdgeY };
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i)
  {
    const glm::dvec3& p = vertices[i];
    const glm::dvec3& q = vertices[(i + 1) % 4];
    const glm::dvec3 cross = glm::cross(p, q);
    const double length = glm::length(cross);
    sum += std::atan2(length, glm::dot(p, q)) * glm::dot(normal, cross) / length;
  }
  return std::abs(sum) / (2.0 * std::acos(-1.0));
}

/// How lanes are shared out: to some neighbouring texels, with some samples of each at a time.
struct Packing
{
  int Samples = Lanes;
  glm::ivec2 Texels{ 1 };

  /// As many samples as there are: rays from one texel to points that are close together on the
  /// light stay together.
  explicit Packing(int samples)
  {
    while (this->Samples > samples)
    {
      // The tile grows to a square in turns.
      this->Samples /= 2;
      (this->Texels.x > this->Texels.y ? this->Texels.y : this->Texels.x) *= 2;
    }
  }

  glm::ivec2 GetTexel(const glm::ivec2& first, int lane) const
  {
    const int texel = lane / this->Samples;
    return first + glm::ivec2(texel % this->Texels.x, texel / this->Texels.x);
  }
};

/// Samples lane by lane, the same of each texel.
struct SamplePacket
{
  Packet<std::uint32_t> X, Y;
  Packet<int> Valid;
};

std::vector<SamplePacket> MakeSamplePackets(
  const std::vector<SobolPoint>& points, const Packing& packing)
{
  const int count = static_cast<int>(points.size());
  std::vector<SamplePacket> packets;
  for (int first = 0; first < count; first += packing.Samples)
  {
    SamplePacket& packet = packets.emplace_back();
    for (int i = 0; i < Lanes; ++i)
    {
      const int sample = first + i % packing.Samples;
      const SobolPoint& point = points[static_cast<std::size_t>(std::min(sample, count - 1))];
      packet.X.Lane[i] = point[0];
      packet.Y.Lane[i] = point[1];
      packet.Valid.Lane[i] = sample < count ? -1 : 0;
    }
  }
  return packets;
}

/// The texels of a packet, lane by lane, and sums over their samples.
struct Tile
{
  Packet<float> X, Y, Z; ///< of the texels' centres, relative to the receiver's corner
  Packet<std::uint32_t> SeedX, SeedY;
  Packet<int> Valid;
  Packet<float> Sum{}, Visible{}; ///< of all samples' weights, of those that arrive
};

/// The scene as rays see it, in floats relative to the receiver's corner.
struct Scene
{
  RTCScene Geometry = nullptr;
  glm::vec3 LightCorner, LightX, LightY, LightNormal, Normal;
};

/// From the texels to points on the light, a point a lane.
void AimRays(const Scene& scene, const Tile& tile, const SamplePacket& samples, RTCRay16& rays)
{
  for (int i = 0; i < Lanes; ++i)
  {
    const float a = Scramble(samples.X.Lane[i], tile.SeedX.Lane[i]);
    const float b = Scramble(samples.Y.Lane[i], tile.SeedY.Lane[i]);
    rays.org_x[i] = tile.X.Lane[i];
    rays.org_y[i] = tile.Y.Lane[i];
    rays.org_z[i] = tile.Z.Lane[i];
    rays.dir_x[i] = scene.LightCorner.x + a * scene.LightX.x + b * scene.LightY.x - rays.org_x[i];
    rays.dir_y[i] = scene.LightCorner.y + a * scene.LightX.y + b * scene.LightY.y - rays.org_y[i];
    rays.dir_z[i] = scene.LightCorner.z + a * scene.LightX.z + b * scene.LightY.z - rays.org_z[i];
    rays.tnear[i] = RayStart;
    rays.tfar[i] = 1.0f;
    rays.time[i] = 0.0f;
    rays.mask[i] = ~0u;
    rays.id[i] = 0;
    rays.flags[i] = 0;
  }
}

/// cos t cos t' / r^2 of each ray; constants cancel in the ratio.
void AddWeights(const Scene& scene, const RTCRay16& rays, const Packet<int>& valid, Tile& tile)
{
  for (int i = 0; i < Lanes; ++i)
  {
    const float x = rays.dir_x[i], y = rays.dir_y[i], z = rays.dir_z[i];
    const float square = x * x + y * y + z * z;
    const float cosine = x * scene.Normal.x + y * scene.Normal.y + z * scene.Normal.z;
    const float lightCosine =
      -(x * scene.LightNormal.x + y * scene.LightNormal.y + z * scene.LightNormal.z);
    const float weight = valid.Lane[i] ? cosine * lightCosine / (square * square) : 0.0f;
    tile.Sum.Lane[i] += weight;
    // Embree sets tfar to minus infinity where something is hit.
    tile.Visible.Lane[i] += rays.tfar[i] >= 0.0f ? weight : 0.0f;
  }
}

void TraceTile(const Scene& scene, const std::vector<SamplePacket>& packets, Tile& tile)
{
  alignas(64) RTCRay16 rays;
#if PENUMBRA_EMBREE_VERSION >= 4
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
#endif
  for (const SamplePacket& samples : packets)
  {
    Packet<int> valid;
    for (int i = 0; i < Lanes; ++i)
    {
      valid.Lane[i] = tile.Valid.Lane[i] & samples.Valid.Lane[i];
    }
    AimRays(scene, tile, samples, rays);
#if PENUMBRA_EMBREE_VERSION >= 4
    rtcOccluded16(valid.Lane, scene.Geometry, &rays, &arguments);
#else
    rtcOccluded16(valid.Lane, scene.Geometry, &context, &rays);
#endif
    AddWeights(scene, rays, valid, tile);
  }
}

/// The centre of a texel, relative to the receiver's corner.
glm::dvec3 GetCentre(const EmbreePeer::Input& input, const glm::ivec2& texel)
{
  const glm::dvec2 share = (glm::dvec2(texel) + 0.5) / glm::dvec2(input.Texels);
  return share.x * input.Base.EdgeX + share.y * input.Base.EdgeY;
}

Tile MakeTile(const EmbreePeer::Input& input, const Packing& packing, const glm::ivec2& first)
{
  Tile tile;
  for (int i = 0; i < Lanes; ++i)
  {
    const glm::ivec2 texel = packing.GetTexel(first, i);
    const glm::vec3 centre(GetCentre(input, texel));
    const auto index = static_cast<std::uint32_t>(texel.y * input.Texels.x + texel.x);
    tile.X.Lane[i] = centre.x;
    tile.Y.Lane[i] = centre.y;
    tile.Z.Lane[i] = centre.z;
    tile.SeedX.Lane[i] = Mix(2 * index + Mix(input.Seed));
    tile.SeedY.Lane[i] = Mix(2 * index + 1 + Mix(input.Seed));
    tile.Valid.Lane[i] = texel.x < input.Texels.x && texel.y < input.Texels.y ? -1 : 0;
  }
  return tile;
}

/// The closed form times the visible share of the samples' weights.
void StoreTile(const EmbreePeer::Input& input, const Packing& packing, const glm::ivec2& first,
  const Tile& tile, std::vector<float>& irradiance)
{
  const glm::dvec3 normal = glm::normalize(glm::cross(input.Base.EdgeX, input.Base.EdgeY));
  penumbra::Parallelogram light = input.Light;
  light.Corner -= input.Base.Corner;
  for (int lane = 0; lane < Lanes; lane += packing.Samples)
  {
    if (tile.Valid.Lane[lane])
    {
      const float* sum = tile.Sum.Lane + lane;
      const float* visible = tile.Visible.Lane + lane;
      const glm::ivec2 texel = packing.GetTexel(first, lane);
      irradiance[static_cast<std::size_t>(texel.y * input.Texels.x + texel.x)] =
        static_cast<float>(GetFormFactor(GetCentre(input, texel), normal, light)) *
        (std::accumulate(visible, visible + packing.Samples, 0.0f) /
          std::accumulate(sum, sum + packing.Samples, 0.0f));
    }
  }
}

/// Rows of tiles, until none is left.
void Work(const EmbreePeer::Input& input, const Scene& scene, const Packing& packing,
  const std::vector<SamplePacket>& packets, std::atomic<int>& nextRow,
  std::vector<float>& irradiance)
{
#if defined(__SSE__)
  _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON); // as Embree advises
#endif
  const int height = packing.Texels.y;
  for (int j = height * nextRow++; j < input.Texels.y; j = height * nextRow++)
  {
    for (int i = 0; i < input.Texels.x; i += packing.Texels.x)
    {
      Tile tile = MakeTile(input, packing, { i, j });
      TraceTile(scene, packets, tile);
      StoreTile(input, packing, { i, j }, tile, irradiance);
    }
  }
}

/// One surface's triangles, relative to `origin`.
void AddSurface(
  RTCDevice device, RTCScene scene, const penumbra::Surface& surface, const glm::dvec3& origin)
{
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
    RTC_FORMAT_FLOAT3, 3 * sizeof(float), surface.Points.size()));
  for (const glm::dvec3& point : surface.Points)
  {
    const glm::vec3 relative(point - origin);
    points = std::copy_n(&relative.x, 3, points);
  }
  auto* corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(geometry,
    RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), surface.Triangles.size()));
  for (const penumbra::Surface::Triangle& triangle : surface.Triangles)
  {
    corners = std::copy(triangle.begin(), triangle.end(), corners);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

} // namespace

struct EmbreePeer::Device
{
  RTCDevice Handle = rtcNewDevice(nullptr);
  ~Device() { rtcReleaseDevice(this->Handle); }
};

EmbreePeer::EmbreePeer()
  : Rays(std::make_unique<Device>())
{
}

EmbreePeer::~EmbreePeer() = default;

std::vector<float> EmbreePeer::Bake(const Input& input)
{
  const double start = GetTime();
  Scene scene;
  scene.Geometry = rtcNewScene(this->Rays->Handle);
  for (const penumbra::Surface& surface : input.Occluders)
  {
    AddSurface(this->Rays->Handle, scene.Geometry, surface, input.Base.Corner);
  }
  rtcCommitScene(scene.Geometry);
  this->BuildSeconds = GetTime() - start;

  scene.LightCorner = glm::vec3(input.Light.Corner - input.Base.Corner);
  scene.LightX = glm::vec3(input.Light.EdgeX);
  scene.LightY = glm::vec3(input.Light.EdgeY);
  scene.LightNormal = glm::vec3(glm::normalize(glm::cross(input.Light.EdgeX, input.Light.EdgeY)));
  scene.Normal = glm::vec3(glm::normalize(glm::cross(input.Base.EdgeX, input.Base.EdgeY)));
  const Packing packing(input.Samples);
  const std::vector<SamplePacket> packets =
    MakeSamplePackets(MakeSobolPoints(input.Samples), packing);
  std::vector<float> irradiance(static_cast<std::size_t>(input.Texels.x * input.Texels.y));
  std::atomic<int> nextRow{ 0 };
  std::vector<std::thread> threads;
  for (unsigned int i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
  {
    threads.emplace_back([&] { Work(input, scene, packing, packets, nextRow, irradiance); });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  rtcReleaseScene(scene.Geometry);
  this->Seconds = GetTime() - start;
  return irradiance;
}
