//! What a program may write in more than one way.

use teaming::Question;

use crate::support::{ask, python, small};

fn groups(question: &Question, body: &str) -> Vec<Vec<u32>> {
    let folder = tempfile::tempdir().unwrap();
    let mut session = python(folder.path(), body, "").open().unwrap();
    ask(&mut *session, 1, question).unwrap_or_else(|error| panic!("{body}: {error}")).assignment.groups
}

#[test]
fn whole_numbers_may_have_a_point() {
    let body = "hello(protocol=1.0, schema_version=3.0)\nanswer([[0.0, 1, 3.0], [2.0, 4.0]])";
    assert_eq!(groups(&small(), body), [vec![0, 1, 3], vec![2, 4]]);
}

#[test]
fn a_group_of_one_may_be_a_number_and_an_empty_one_null() {
    let mut question = small();
    question.members.retain(|member| member.id == 0);
    question.quotas[0].members = vec![1, 0];
    question.quotas[1].members = vec![0, 0];
    for text in ["[0, None]", "[[0], []]", "[0.0, {}]"] {
        assert_eq!(groups(&question, &format!("hello()\nanswer({text})")), [vec![0], vec![]]);
    }
    assert_eq!(groups(&question, "hello()\nanswer([0, None], idle=None)"), [vec![0], vec![]]);
}

#[test]
fn a_program_hears_who_asks_and_what_its_options_are() {
    let folder = tempfile::tempdir().unwrap();
    let body = "
told = hello()
asked = read()
print(json.dumps([told, asked | {'question': asked['question']['round']}]), file=sys.stderr)
time.sleep(0.1)
send({'type': 'error', 'id': asked['id'], 'message': 'enough'})";
    let mut policy = python(folder.path(), body, ", options: (depth: 3, names: [\"a\"], rule: Sum)");
    policy = policy.labelled("mine");
    let mut session = policy.open().unwrap();
    let error = ask(&mut *session, 7, &small()).unwrap_err().to_string();
    let (head, told) = error.split_once("\nits standard error ends with:\n  ").unwrap();
    assert_eq!(head, "round 1: it gave up: enough");
    let expected = "[{\"type\": \"hello\", \"protocol\": 1, \"schema_versions\": [3], \
        \"usar\": \"0.1.0\", \"policy\": \"mine\", \
        \"options\": {\"depth\": 3, \"names\": [\"a\"], \"rule\": \"Sum\"}, \"process\": 0}, \
        {\"type\": \"question\", \"id\": 1, \"trial\": {\"number\": 1, \"scenario\": \"paper\"}, \
        \"question\": 1}]";
    assert_eq!(told, expected);
}

#[test]
fn a_program_may_write_much_to_its_standard_error() {
    let body = "hello()\nfor _ in range(20000): print('x' * 79, file=sys.stderr)\nanswer()";
    assert_eq!(groups(&small(), body).len(), 2);
}
