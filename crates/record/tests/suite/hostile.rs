//! Devices that do not follow their protocols: an error in time, no panic, no memory without bound.

use super::recorded;
use proptest::prelude::*;
use std::io::{Read, Write};
use std::net::TcpListener;
use stiction_record::{Device, Error, Fault};

/// A server that answers the first request with these bytes and ends the connection; its address.
fn answers(bytes: Vec<u8>) -> (std::net::SocketAddr, std::thread::JoinHandle<()>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let at = listener.local_addr().unwrap();
    let thread = std::thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        let _ = stream.read(&mut [0; 4096]);
        let _ = stream.write_all(&bytes);
    });
    (at, thread)
}

/// What comes of connecting to it.
fn connected(words: &str, bytes: Vec<u8>) -> Fault {
    let (at, thread) = answers(bytes);
    let words: Vec<String> = words
        .replace("HOST", &at.to_string())
        .split(' ')
        .map(String::from)
        .collect();
    let mut source = Device::parse(&words).unwrap().source(None).unwrap();
    let result = source.connect();
    thread.join().unwrap();
    match result {
        Err(Error::Device { fault, .. }) => fault,
        other => panic!("{other:?}"),
    }
}

const ADS: &str = "ads://1.2.3.4.1.1:851@HOST/MAIN.x MAIN.y";
const RTDE: &str = "rtde://HOST";

/// A packet of AMS: command, error, number of the request, data.
fn packet(command: u16, error: u32, id: u32, data: &[u8]) -> Vec<u8> {
    let mut packet = vec![0, 0];
    packet.extend((32 + data.len() as u32).to_le_bytes());
    packet.extend([0; 16]);
    packet.extend(command.to_le_bytes());
    packet.extend(5_u16.to_le_bytes());
    packet.extend((data.len() as u32).to_le_bytes());
    packet.extend(error.to_le_bytes());
    packet.extend(id.to_le_bytes());
    packet.extend(data);
    packet
}

#[test]
fn a_length_beyond_all_sense_is_refused_before_it_is_taken() {
    // 4 GB announced.
    assert_eq!(
        connected(ADS, vec![0, 0, 255, 255, 255, 255, 1]),
        Fault::Malformed
    );
    assert_eq!(connected(RTDE, vec![0, 2, b'V', 1]), Fault::Malformed);
}

#[test]
fn answers_that_are_cut_or_refused_say_so() {
    assert_eq!(connected(ADS, packet(9, 7, 1, &[])), Fault::Refused);
    assert_eq!(connected(ADS, packet(9, 0, 1, &[1, 7])), Fault::Malformed);
    assert_eq!(connected(ADS, packet(9, 0, 1, &[0; 4])), Fault::Refused);
    // The answer to another request is none.
    assert_eq!(connected(ADS, packet(9, 0, 77, &[0; 40])), Fault::Closed);
    assert_eq!(connected(RTDE, vec![0, 4, b'V', 0]), Fault::Refused);
    assert_eq!(connected(RTDE, vec![0, 3, b'V']), Fault::Malformed);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn any_bytes_of_a_robot_are_an_error(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        connected(RTDE, bytes);
    }

    #[test]
    fn any_bytes_of_a_plc_are_an_error(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        connected(ADS, bytes);
    }

    #[test]
    fn any_answer_to_a_look_up_is_an_error(
        command in prop::sample::select(vec![8_u16, 9]),
        data in prop::collection::vec(prop_oneof![Just(0_u8), 0..6_u8, any::<u8>()], 0..80),
    ) {
        connected(ADS, packet(command, 0, 1, &data));
    }

    /// Whole set-up, then anything as packages.
    #[test]
    fn any_data_of_a_robot_are_taken_or_an_error(
        data in prop::collection::vec(prop_oneof![Just(0_u8), Just(b'U'), 0..6_u8, any::<u8>()], 0..700),
    ) {
        let kinds = b"\x01DOUBLE,VECTOR6D,VECTOR6D,VECTOR6D,VECTOR6D,VECTOR6D,VECTOR6D";
        let outputs = [&[0, 3 + kinds.len() as u8, b'O'][..], kinds].concat();
        // A first package of the right length with any numbers.
        let numbers: Vec<u8> = data.iter().copied().cycle().take(8 * 37 * usize::from(!data.is_empty())).collect();
        let first = [&[(300_u16 >> 8) as u8, 300_u16 as u8, b'U', 1][..], &numbers].concat();
        let sent = [&[0, 4, b'V', 1][..], &outputs, &[0, 4, b'S', 1], &first, &data];
        let (at, thread) = answers(sent.concat());
        let dir = tempfile::tempdir().unwrap();
        let done = recorded(&[format!("rtde://{at}")], 125.0, 1.0, &dir.path().join("log.csv"));
        thread.join().unwrap();
        prop_assert!(done.is_err() || done.unwrap().rows > 0);
    }

    /// Whole set-up, then anything as notifications.
    #[test]
    fn any_notification_is_taken_or_an_error(
        data in prop::collection::vec(prop_oneof![Just(0_u8), 0..9_u8, any::<u8>()], 0..120),
    ) {
        let found = [0_u32, 30, 30, 0x4040, 0, 8, 5, 0];
        let found: Vec<u8> = found.iter().flat_map(|n| n.to_le_bytes()).collect();
        let handle = [0_u32, 1];
        let handle: Vec<u8> = handle.iter().flat_map(|n| n.to_le_bytes()).collect();
        let whole = [&((data.len() + 4) as u32).to_le_bytes()[..], &1_u32.to_le_bytes(), &data].concat();
        let sent = [
            packet(9, 0, 1, &found),
            packet(6, 0, 2, &handle),
            packet(8, 0, 0, &whole),
        ];
        let (at, thread) = answers(sent.concat());
        let dir = tempfile::tempdir().unwrap();
        let words = vec![format!("ads://1.2.3.4.1.1:851@{at}/MAIN.x")];
        let done = recorded(&words, 1000.0, 1.0, &dir.path().join("log.csv"));
        thread.join().unwrap();
        prop_assert!(done.is_err() || done.unwrap().rows > 0);
    }
}
