//! A robot that speaks RTDE, protocol version 2.

use super::{Script, Served, Server, value};
use std::io::Write;
use std::net::SocketAddr;

/// Time stamp of the first sample, s.
const BEGIN: f64 = 4321.125;

/// The server; it ends with the value.
pub struct Robot {
    server: Server,
    rate: f64,
}

/// How far a robot is.
struct State {
    rate: f64,
    script: Script,
    next: usize,
}

impl Robot {
    /// Starts a robot that has a rate in Hz and refuses others.
    pub fn start(rate: f64, script: Script) -> Self {
        let mut state = State {
            rate,
            script,
            next: 0,
        };
        let server = Server::start(move |served| state.serve(served));
        Self { server, rate }
    }

    /// Where it listens.
    pub fn at(&self) -> SocketAddr {
        self.server.at
    }

    /// Commands that it refused; waits until no client is connected.
    pub fn refused(&self) -> Vec<String> {
        self.server.refused()
    }

    /// The time stamp of a sample, s.
    pub fn time(&self, sample: usize) -> f64 {
        BEGIN + sample as f64 / self.rate
    }
}

impl State {
    fn serve(&mut self, mut served: Served) -> bool {
        let mut outputs = 0;
        loop {
            let Some(head) = served.read(3) else {
                return true;
            };
            let length = usize::from(u16::from_be_bytes([head[0], head[1]]));
            let Some(content) = served.read(length - 3) else {
                return true;
            };
            let answer = match head[2] {
                // Version of the controller: asked by other clients, and no input.
                b'v' => [5_u32, 12, 0, 0].map(u32::to_be_bytes).concat(),
                b'V' => vec![u8::from(content == [0, 2])],
                b'O' => {
                    let rate = f64::from_be_bytes(content[..8].try_into().expect("eight bytes"));
                    let names = String::from_utf8_lossy(&content[8..]).into_owned();
                    let kind = |name: &str| match name {
                        "timestamp" => "DOUBLE",
                        "actual_q" | "actual_qd" | "actual_current" | "target_q"
                        | "target_moment" | "joint_temperatures" => "VECTOR6D",
                        _ => "NOT_FOUND",
                    };
                    let kinds: Vec<&str> =
                        names.trim_end_matches(',').split(',').map(kind).collect();
                    outputs = 6 * kinds.iter().filter(|kind| **kind == "VECTOR6D").count();
                    let recipe = u8::from(rate == self.rate);
                    [&[recipe], kinds.join(",").as_bytes()].concat()
                }
                b'S' => vec![1],
                b'P' => vec![1],
                kind => {
                    served.refuse(format!("RTDE package of kind {:?}", char::from(kind)));
                    return true;
                }
            };
            if send(&mut served, head[2], &answer).is_none() {
                return true;
            }
            if head[2] != b'S' {
                continue;
            }
            // A message for people, as controllers send at any time.
            let _ = send(&mut served, b'M', b"\x05hello\x04test\x03");
            while self.next < self.script.samples {
                let k = self.next;
                if self.script.cuts.remove(&k) {
                    return true;
                }
                self.next += 1;
                if self.script.lost.contains(&k) {
                    continue;
                }
                let time = BEGIN + k as f64 / self.rate;
                let values = (0..outputs).map(|column| value(k, column));
                let numbers = std::iter::once(time).chain(values);
                let data: Vec<u8> = numbers.flat_map(f64::to_be_bytes).collect();
                if send(&mut served, b'U', &[&[1], &data[..]].concat()).is_none() {
                    return true;
                }
            }
            if self.script.gone {
                return false;
            }
        }
    }
}

fn send(served: &mut Served, kind: u8, content: &[u8]) -> Option<()> {
    let length = u16::try_from(3 + content.len()).expect("a short package");
    let package = [&length.to_be_bytes()[..], &[kind], content].concat();
    served.stream.write_all(&package).ok()
}
