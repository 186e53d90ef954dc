// Pictures between two threads, neither of which waits for the other.
#include "headset/picture_exchange.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <set>
#include <thread>

#include "support.h"

namespace trephine {
namespace {

using namespace std::chrono_literals;
using Of = PictureRequest::Of;

PictureRequest request(std::uint64_t number, Of of = Of::eyes) {
  PictureRequest made;
  made.number = number;
  made.of = of;
  return made;
}

TEST(PictureExchange, TheNewestRequestIsAnsweredOnceAndTheNewestPictureIsShown) {
  PictureExchange exchange;
  EXPECT_FALSE(exchange.asked());
  exchange.ask(request(1));
  exchange.ask(request(2));
  EXPECT_EQ(exchange.asked()->number, 2u);
  EXPECT_FALSE(exchange.asked());
  for (std::uint64_t number : {2u, 3u}) {
    exchange.finish(*exchange.begin(Of::eyes), request(number), nullptr);
  }
  SharedPicture* shown = exchange.take(Of::eyes, 2, 0us);
  ASSERT_TRUE(shown);
  EXPECT_EQ(shown->request.number, 3u);
  EXPECT_FALSE(exchange.take(Of::eyes, 4, 1ms)) << "the one before was never shown, and is free";
}

TEST(PictureExchange, WhileOneIsShownOthersCanBeDrawnAndNeitherKindTakesTheOthers) {
  PictureExchange exchange;
  exchange.finish(*exchange.begin(Of::eyes), request(1), nullptr);
  exchange.finish(*exchange.begin(Of::panel), request(2, Of::panel), nullptr);
  SharedPicture* pair = exchange.take(Of::eyes, 1, 0us);
  SharedPicture* panel = exchange.take(Of::panel, 0, 0us);
  ASSERT_TRUE(pair && panel && pair != panel);
  std::set<SharedPicture*> drawing;
  while (SharedPicture* next = exchange.begin(Of::eyes)) drawing.insert(next);
  EXPECT_EQ(drawing.size(), 2u);
  EXPECT_FALSE(drawing.contains(pair) || drawing.contains(panel));
  exchange.giveUp(**drawing.begin());
  EXPECT_EQ(exchange.begin(Of::eyes), *drawing.begin());
  exchange.giveBack(*pair);
  EXPECT_EQ(exchange.begin(Of::eyes), pair);
}

TEST(PictureExchange, WaitingForAPictureEndsWithItWithTimeOrWhenItIsCancelled) {
  PictureExchange exchange;
  const auto untilThisWaits = [waiting = ::gettid()] {
    EXPECT_TRUE(test::waitUntil([&] { return test::isWaiting(waiting); }));
  };
  std::thread window([&] {
    untilThisWaits();
    exchange.finish(*exchange.begin(Of::eyes), request(7), nullptr);
  });
  SharedPicture* shown = exchange.take(Of::eyes, 7, 30s);
  window.join();
  ASSERT_TRUE(shown);
  EXPECT_EQ(shown->request.number, 7u);
  EXPECT_FALSE(exchange.take(Of::eyes, 8, 1ms));
  std::thread stop([&] {
    untilThisWaits();
    exchange.cancelWaiting();
  });
  const auto from = std::chrono::steady_clock::now();
  EXPECT_FALSE(exchange.take(Of::eyes, 8, 30s));
  EXPECT_LT(std::chrono::steady_clock::now() - from, 10s);
  stop.join();
}

}  // namespace
}  // namespace trephine
