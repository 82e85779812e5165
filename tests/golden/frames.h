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
    {"builtin:city", "lecture", 200, 150, "5df0d9a451493503675f42baa09517f32e353914d2721571543c1b1e3baed9ab"},
    {"builtin:rabbits", "lecture", 200, 150, "1b77637ea908b58118de27e778f7610354b7a6e545468c97681dd948f92e1a6b"},
    {"builtin:sphere", "lecture", 200, 150, "0a03aace5ec3abc59c0e439d113bc38aeb437fa7ea728d162ca2c5b42887faff"},
    {"builtin:red", "lecture", 200, 150, "f662f30785d05d716414100444ab99ffde536f98945f5e29dc5ccd06c12a11b8"},
    {"builtin:cornell", "lecture", 200, 150, "180bb43ac98d1b3df1d7d6d74c720ee67155e0b39b5c8f20fcc88780a874a050"},
    {"builtin:circle", "lecture", 200, 150, "d7ec7e55264f0ba154c027eed4080e4ec7495c152efbe95826650faa07da293c"},
    {"builtin:city", "light-volumes", 200, 150, "85a58fca00110ae41391d671ab3bdf0a67451fcbf3d3447d48000765eb45407c"},
    {"builtin:rabbits", "light-volumes", 200, 150, "70ef27d79686074c1f1e52b5eed4618174220c7489dc4b8680dfffe8104fc520"},
    {"builtin:sphere", "light-volumes", 200, 150, "41da4afb8cbf655c067e9169ebe435541b8c877768f2e0f73088e1cc8a34d95f"},
    {"builtin:red", "light-volumes", 200, 150, "8b991ae563a61b4f0ede8dab14b3f1bc922d6b9e2f2833f4b8d6dd408e210b72"},
    {"builtin:cornell", "light-volumes", 200, 150, "9264b7bfc794dbcde43209916d56ea4db9e575ce7e7ee66bc96ec8453e482db0"},
    {"builtin:circle", "light-volumes", 200, 150, "a2cbbbdf3c196999eefe248ca1d33261988bc54cfedb91ab2f90ae6ac93671f2"},
    {"builtin:city", "light-volumes-literal", 200, 150, "568438df4218b0e306c8b451fbca622c222dc59e0c9d03e434159177046170af"},
    {"builtin:rabbits", "light-volumes-literal", 200, 150, "79edb8d2e8829a5a23a4ee7abd794a0229b8736df7d9ffa40b27044d05c5baee"},
    {"builtin:sphere", "light-volumes-literal", 200, 150, "b1b18c7fd709e0e873b696e354c0c42e5cb3b789eab83c139149f68ccd13a9b9"},
    {"builtin:red", "light-volumes-literal", 200, 150, "28613f5ee264a88fd23ac94b1a59baa06339d31abcc73a50eefddd4672646095"},
    {"builtin:cornell", "light-volumes-literal", 200, 150, "b29052affc8517832041c804c9bbb288591517e84226069443d8a8f0cee2fb85"},
    {"builtin:circle", "light-volumes-literal", 200, 150, "86b5e14735da15db6ce3af0c246f23f76445b99e0eb4fc25faf9ddc2350836e1"},
    {"builtin:city", "redsdk", 200, 150, "b4df0ca1acecb0b75d56c7d610264d4506832937f99158d471ce6db89d6bc8f9"},
    {"builtin:rabbits", "redsdk", 200, 150, "d041bd9d1c320ebbfe62fee4e8c8207d532c24401667286dcdff036cefda03ad"},
    {"builtin:sphere", "redsdk", 200, 150, "826cafc6233691295fd25bf5b63f2bbf73cb37f730a3954151a2170d1523076c"},
    {"builtin:red", "redsdk", 200, 150, "a46a5c80c18b281c150b736864fb782f5889567b51a8d5219e64513b7adadec2"},
    {"builtin:cornell", "redsdk", 200, 150, "ba90d2db44db62ace19888cc0cef098decad0cad15f2b884b9da9a9d8242ab5d"},
    {"builtin:circle", "redsdk", 200, 150, "dc2108874f6cb08445c3b6e1c0f675de299b02bbf0f157b82403b25702dc70c5"},
};

}  // namespace trueshade
