//! A question of a trial (scenario `paper.ron`, seed 1, round 3), with the answers of the rivals as an
//! independent program in Python computed them: by brute force, or step by step.

use rne_core::NeedVector;
use teaming::decision::Protocol;
use teaming::question::hardest_first;
use teaming::{Account, GroupSizes, Member, Need, Question, Quota, RoleId, Task};

use crate::rivals::{distrust, spread, total};
use crate::support::decide;

/// Role, home, and the needs that differ within a role: hp, v, sen, eng, obs.
const MEMBERS: [(u16, [f64; 2], [f64; 5]); 12] = [
    (
        0,
        [40.099_998_474_121_094, 13.800_000_190_734_863],
        [
            87.405_130_465_608_27,
            2.108_307_717_738_093,
            2.811_076_956_984_124,
            102.924_551_995_013_9,
            0.005_622_153_913_968_249,
        ],
    ),
    (0, [42.619_998_931_884_766, 13.800_000_190_734_863], [100.0, 2.25, 3.0, 147.279_750_000_004_19, 0.006]),
    (
        0,
        [45.139_999_389_648_44, 13.800_000_190_734_863],
        [
            97.036_790_617_044_05,
            2.216_663_894_441_745_6,
            2.955_551_859_255_660_7,
            101.683_342_134_433_64,
            0.005_911_103_718_511_322,
        ],
    ),
    (
        0,
        [47.659_999_847_412_11, 13.800_000_190_734_863],
        [
            96.076_643_021_642_41,
            2.205_862_233_993_477_3,
            2.941_149_645_324_636_6,
            82.363_533_110_508_23,
            0.005_882_299_290_649_272_6,
        ],
    ),
    (
        0,
        [50.180_000_305_175_78, 13.800_000_190_734_863],
        [
            73.386_179_380_548_98,
            1.950_594_518_031_176_1,
            2.600_792_690_708_235,
            92.926_444_944_670_73,
            0.005_201_585_381_416_469_5,
        ],
    ),
    (0, [52.700_000_762_939_45, 13.800_000_190_734_863], [100.0, 2.25, 3.0, 47.060_926_891_687_465, 0.006]),
    (
        1,
        [43.900_001_525_878_906, 16.0],
        [
            81.871_720_864_307_97,
            2.046_056_859_723_464_5,
            2.728_075_812_964_619_7,
            108.480_750_000_063_98,
            0.005_456_151_625_929_239,
        ],
    ),
    (
        1,
        [45.566_665_649_414_06, 16.0],
        [
            87.079_449_916_071_67,
            2.104_643_811_555_806_4,
            2.806_191_748_741_075_5,
            108.568_500_000_063_85,
            0.005_612_383_497_482_15,
        ],
    ),
    (
        1,
        [47.233_333_587_646_484, 16.0],
        [
            85.567_179_532_124_94,
            2.087_630_769_736_405_6,
            2.783_507_692_981_874,
            91.853_297_372_855_65,
            0.005_567_015_385_963_749,
        ],
    ),
    (
        1,
        [48.900_001_525_878_906, 16.0],
        [
            94.097_710_176_244_45,
            2.183_599_239_482_75,
            2.911_465_652_643_667,
            109.534_502_079_456_2,
            0.005_822_931_305_287_333_5,
        ],
    ),
    (2, [45.900_001_525_878_906, 18.200_000_762_939_453], [50.0, 1.5, 18.0, 97.282_000_000_004_19, 6.0]),
    (2, [46.900_001_525_878_906, 18.200_000_762_939_453], [50.0, 1.5, 18.0, 55.014_276_955_738_59, 6.0]),
];

fn third_round() -> Question {
    let member = |(id, (role, home, [hp, v, sen, eng, obs])): (u32, (u16, [f64; 2], [f64; 5]))| {
        let [res, cap] = [[1.0, 6.0], [10.0, 1.0], [0.0, 0.0]][usize::from(role)];
        Member {
            id,
            role: RoleId(role),
            home,
            needs: NeedVector::new(vec![hp, v, sen, eng, res, cap, obs]).unwrap(),
            levels: Vec::new(),
        }
    };
    let tasks = [("hard", 2, [15.6, 64.2]), ("easy", 1, [73.4, 51.6])];
    let task = |(name, difficulty, place)| Task { place: Some(place), ..Task::new(name, difficulty) };
    let names = ["hp", "v", "sen", "eng", "res", "cap", "obs"];
    let question = Question {
        round: 3,
        roles: crate::support::ROLES.map(str::to_owned).to_vec(),
        needs: names.map(|name| Need { name: name.to_owned(), weight: 1.0 }).to_vec(),
        quotas: Quota::equal(&[6, 4, 2], &hardest_first(tasks.iter().map(|task| task.1))),
        tasks: tasks.map(task).to_vec(),
        members: (0..).zip(MEMBERS).map(member).collect(),
        ..Question::default()
    };
    question.checked().unwrap()
}

#[track_caller]
fn is_close(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-12, "{found} {expected}");
}

#[test]
fn the_third_round_of_a_trial_is_answered_as_another_program_does() {
    let question = third_round();
    let groups = |policy: &str| decide(policy, &question).assignment.groups;
    assert_eq!(groups("OPTIMAL"), [[0, 1, 2, 6, 7, 10], [3, 4, 5, 8, 9, 11]]);
    is_close(total(&question, &decide("OPTIMAL", &question).assignment), -1.077_915_908_878_983);
    assert_eq!(groups("GREEDY"), [[0, 1, 2, 7, 9, 10], [3, 4, 5, 6, 8, 11]]);
    is_close(total(&question, &decide("GREEDY", &question).assignment), -1.145_672_613_903_569_3);
    assert_eq!(groups("SNAKE"), [[0, 1, 5, 8, 9, 10], [2, 3, 4, 6, 7, 11]]);
    is_close(spread(&question, &decide("SNAKE", &question).assignment), 0.200_737_898_385_891_18);
    is_close(spread(&question, &decide("BALANCE", &question).assignment), 0.000_528_592_553_617_812_7);
    is_close(distrust(&question, &decide("SIMILAR", &question).assignment), 0.136_070_842_703_107_7);
    is_close(inertia(&question, &groups("KMEANS")), 78.822_855_423_831_16);
}

#[test]
fn robots_send_as_many_messages_as_in_another_program() {
    let question = third_round();
    let sent = |policy: &str| match decide(policy, &question).account {
        Account::Protocol(sent) => sent,
        other => panic!("{other:?}"),
    };
    let full = Protocol { rounds: 7, messages: 276, bytes: 24_192 };
    assert_eq!(sent("GREEDY(protocol: Cbba)"), full);
    let line = Protocol { rounds: 10, messages: 160, bytes: 13_248 };
    assert_eq!(sent("GREEDY(protocol: Cbba, graph: Line)"), line);
}

#[test]
fn grape_moves_each_robot_once_if_sizes_are_free() {
    let mut question = third_round();
    question.quotas.iter_mut().for_each(|quota| quota.sizes = GroupSizes::Free);
    let decision = policies::standard().parse("GRAPE").unwrap().decide(&question).unwrap();
    decision.assignment.check(&question).unwrap();
    assert_eq!(decision.assignment.groups, [[0, 1, 6, 8, 10, 11], [2, 3, 4, 5, 7, 9]]);
    // 12 moves: six, four and two, each told to the other robots of the role.
    let Account::Protocol(sent) = decision.account else { panic!("{:?}", decision.account) };
    assert_eq!(
        sent,
        Protocol { rounds: 6, messages: 6 * 5 + 4 * 3 + 2, bytes: 8 * (30 * 8 + 12 * 6 + 2 * 4) }
    );
}

/// The sum of squared distances of standardised needs to the means of the groups.
fn inertia(question: &Question, groups: &[Vec<u32>]) -> f64 {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let squares = |values: &[f64]| values.iter().map(|value| (value - mean(values)).powi(2)).sum::<f64>();
    let of_need = |k: usize| {
        let values = |ids: &[u32]| -> Vec<f64> {
            ids.iter().map(|id| question.members[*id as usize].needs.values()[k]).collect()
        };
        let all: Vec<u32> = question.members.iter().map(|member| member.id).collect();
        let variance = squares(&values(&all)) / all.len() as f64;
        groups.iter().map(|group| squares(&values(group))).sum::<f64>() / variance
    };
    (0..question.needs.len()).map(of_need).sum()
}
