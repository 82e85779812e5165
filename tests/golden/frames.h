#pragma once
#include <string_view>

namespace trueshade {

/// What a frame hashes to. A tripwire against change, not evidence of truth: the oracle, Embree and OpenGL judge that.
/// Recorded with g++ 12.2 on AVX-512; every other compiler, target and machine must agree.
struct GoldenFrame {
  std::string_view scene, preset;
  int width, height;
  std::string_view hash;
};

inline constexpr GoldenFrame kGoldenFrames[] = {
    {"builtin:city", "many-lights", 200, 150, "ef6e98ec2c49765ecfcc2d5e501aeb6764588689dec9f3fafc33aba6969557a6"},
    {"builtin:city", "many-lights", 800, 800, "132054ef60770fea90789731ca120d8af0f5f2d79e3adebfeae7fea20ccc38a7"},
    {"builtin:city", "touchdesigner", 200, 150, "1acd2417f1901cfd23ff4b99c6aa541bdcb4ef0042eb92390fe5dd783bd34667"},
    {"builtin:rabbits", "many-lights", 200, 150, "adf5fe3f1b442863b42436a84ef75c0f9ec34dc64e530f04dd7943c3ed9e9b68"},
    {"builtin:rabbits", "many-lights", 800, 800, "7f8102d20e465245bfacfddf20a4cafd5df165959da961c9932e44ed89d5b4c6"},
    {"builtin:rabbits", "touchdesigner", 200, 150, "40842e9245b3043c4be9c00e4724f777d68f057fda8486a15004567cf72d0eab"},
    {"builtin:sphere", "many-lights", 200, 150, "1cbb28beff1ce1741d08faad227ce298d984b0d766e5cb79caaef97d0bea2b7f"},
    {"builtin:sphere", "many-lights", 800, 800, "3f1926288b4583aed3c01e7de33133660959f74f6b2d781fe0047dc4b0939f16"},
    {"builtin:sphere", "touchdesigner", 200, 150, "e83022eb3cc1d1f35a92fa3b5f8faae4173539a7b253c557aac3edd47163180d"},
    {"builtin:red", "many-lights", 200, 150, "68ea17e046d204d0f1d65950317dd6ff25c32b9381ddb88eba49b8218a5cf3d5"},
    {"builtin:red", "many-lights", 800, 800, "4ffc0002537a1b6a4a8977e3f9a98ab69d215fd58101c2a6c9ed5225713a1ded"},
    {"builtin:red", "touchdesigner", 200, 150, "34b8191dc42b8f121925d68ba600cf1379ebec5b9f0b6e22df7d6dd5201dcdf1"},
    {"builtin:cornell", "many-lights", 200, 150, "f33dc84567c0f1a3ba8c4737956542f19727b4781cfca4811449e93969a40493"},
    {"builtin:cornell", "many-lights", 800, 800, "7206c841b0f8d5711014a465e8f1d2b64965780489233e9ac3ece60bf15e7831"},
    {"builtin:cornell", "touchdesigner", 200, 150, "fcc47f0384d30366d0a633d6b008c20836d9a46269b36d18763222a0eac80774"},
    {"builtin:circle", "many-lights", 200, 150, "b3b35243c9ea2478ca69dab08514428b2554d21a854842980cad287596f62afd"},
    {"builtin:circle", "many-lights", 800, 800, "19fb26401f10284da6c15b234376ac91a0995563e27db40e408f26dcdce9b416"},
    {"builtin:circle", "touchdesigner", 200, 150, "a664717ba76afedcc23bf1bed519fbd48f51bee7886a9715487e6a091339f213"},
    {"builtin:city", "gl-fixed", 200, 150, "a1c4c09062d4d28f0cc057f02f49de3aef8ac83efb820ba18a0435f939d22566"},
    {"builtin:rabbits", "gl-fixed", 200, 150, "e2746ace9f9356b098b957095ea2cf1e6bb979109886d002b1e193cc6a6270d4"},
    {"builtin:sphere", "gl-fixed", 200, 150, "efd30f7244aca401ebedf63c5e45181b53e052ce07617f080aa9283ccd08a71a"},
    {"builtin:red", "gl-fixed", 200, 150, "9cdec48256846d6e4fa4750bfac2b547fe731c9adca7f4640ebddc3da822eee6"},
    {"builtin:cornell", "gl-fixed", 200, 150, "3676a44e9921bc99287aba142efaf9014b2845d94b4bf4f16f016410f97e79fa"},
    {"builtin:circle", "gl-fixed", 200, 150, "7e8834e69b5c26fda69e4ced9d9967ede778ade800bfa62e1ea5e701e425c0b6"},
    {"builtin:city", "punctual", 200, 150, "ca9e26de406603ccbc2638455a236f741eba4f9baf55039566e49520c0624fce"},
    {"builtin:rabbits", "punctual", 200, 150, "5c302d0ec861187c7c545db2d7fbf20c2295437e9e8e3ebfa4f02293ac5161f3"},
    {"builtin:sphere", "punctual", 200, 150, "07035f158de9968e2becded326e64d4f72d03d7f9bb193dc3747ca7edfe53ad0"},
    {"builtin:red", "punctual", 200, 150, "3ceb8cab711fed7251c598792a15beebf5d0b4605acb4cf7e6bcdb06f535d845"},
    {"builtin:cornell", "punctual", 200, 150, "5ff9d04dad12afc127f6eae96fe1a79ea9466c17339f6211f5ffbb0a21e77824"},
    {"builtin:circle", "punctual", 200, 150, "155bd7b878652001c8ec6d1bb2fd3a014c3173ac09f6274f2ad66517ed87051d"},
    {"builtin:atrium", "many-lights", 200, 150, "a6c74d389ee87813a5f86fb080c918c5235ade4e605767347bae832bf264b664"},
    {"builtin:atrium", "many-lights", 800, 800, "3db7c70e68f9f68cfb1fb160e9608b8b766e31e0331cd080733b5b5cf41576a5"},
    {"builtin:atrium", "touchdesigner", 200, 150, "9aa6c8d69abe07218c962698eb8ae9e19a25c0bd1007e43ebf32885506aed78c"},
};

}  // namespace trueshade
